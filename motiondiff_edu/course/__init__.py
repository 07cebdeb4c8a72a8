"""What only notebooks use.

Profile and seed, exercise checks and their bug zoo, doctor, lab and demo.
"""
