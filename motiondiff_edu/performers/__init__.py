"""A trained network with everything it needs for use: units, schedule, data windows.

This package also measures which parts of the music a dancer uses.
"""
