"""Measures of motion, as pure functions of arrays: what each counts, and what it is blind to.
Notebook: 08"""
