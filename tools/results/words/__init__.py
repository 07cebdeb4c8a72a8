"""Motion from text: the trials, the rows of Table 2, and their measures."""
