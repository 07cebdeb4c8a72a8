"""Measures of motion, as pure functions of arrays. Each file says what its measure does not see.

Notebook: 08
"""
