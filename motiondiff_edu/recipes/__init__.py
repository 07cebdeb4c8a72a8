"""How the shipped weights were trained: recipes, optimisers, runs on disk.

`python -m motiondiff_edu.recipes`.
"""
