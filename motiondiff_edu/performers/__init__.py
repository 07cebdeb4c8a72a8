"""A trained network with all it needs to perform: units, schedule, data windows; and what it
listened to."""
