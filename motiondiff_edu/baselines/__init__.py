"""What the networks are compared with, each on the same windows and walked by the same rollout."""
