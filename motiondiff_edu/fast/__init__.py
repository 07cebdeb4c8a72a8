"""Fast twins of the core: tests compare each with the plain version that the course explains."""
