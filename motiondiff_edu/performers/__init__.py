"""A trained network with all it needs to perform: units, schedule, data windows.

What it listened to is there as well.
"""
