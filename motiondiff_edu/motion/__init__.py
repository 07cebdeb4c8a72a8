"""Motion as arrays: the skeleton, forward kinematics, the root frame, clips, and the files they
come from."""
