"""What a network does, looked at as single notebooks show it."""
