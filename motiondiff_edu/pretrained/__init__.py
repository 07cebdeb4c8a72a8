"""Shipped weights, each with its card; saving and loading them without running code."""
