"""Code that only the notebooks use.

It holds profile and seed, the checks of the exercises and their bug zoo, doctor, lab and demo.
"""
