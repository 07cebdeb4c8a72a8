"""Shipped weights, each with its card, and the recipes that make them: `python -m motiondiff_edu.pretrained`."""
