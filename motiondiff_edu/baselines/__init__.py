"""Baselines for the networks; each uses the same windows, and walkers use the same rollout."""
