"""What holds of the exercises' checks."""
