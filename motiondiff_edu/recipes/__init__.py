"""How the shipped weights are trained: recipes, optimisers, runs on disk.

`python -m motiondiff_edu.recipes` trains them.
"""
