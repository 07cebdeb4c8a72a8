"""What a motion is asked to follow."""
