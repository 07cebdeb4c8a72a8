"""Masks, in-betweens, edits and repairs: the models behind the editor and the bench."""
