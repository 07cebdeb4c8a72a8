"""The conditions that a motion follows: a control, or music."""
