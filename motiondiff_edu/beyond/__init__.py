"""Departures from the papers, one idea a file.

Each file says what it is, why, and what it gains (a row of docs/RESULTS.md).
"""
