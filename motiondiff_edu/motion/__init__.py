"""Motion as arrays.

The skeleton, forward kinematics, the root frame, clips, and the files they come from.
"""
