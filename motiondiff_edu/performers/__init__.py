"""A trained network with everything it needs for use: units, schedule, data windows."""
