"""Canvas and controls for notebooks.

They show what the library computed and hold no arithmetic of their own.
"""
