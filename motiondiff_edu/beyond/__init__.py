"""Departures from the papers, one idea per file.

Each file says what the idea is, why it helps, and what it gains (a row of docs/RESULTS.md).
"""
