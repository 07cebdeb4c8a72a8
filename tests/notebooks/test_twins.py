"""The step-by-step versions in the notebooks agree with the library.

Cells tagged `twin`, run and compared.
"""

import functools

import notebook_cells
import numpy as np
import pytest
import torch
from twins_table import TWINS

PATHS = {path.stem[:2]: path for path in notebook_cells.sources()}


@functools.cache
def names(notebook: str) -> dict:
    """What the cells tagged imports, setup and twin define.

    They run in a fresh namespace without any other cell.
    """
    content = notebook_cells.read(PATHS[notebook])
    space = notebook_cells.start(content, PATHS[notebook].stem)
    return notebook_cells.run(notebook_cells.code(content, "twin"), space, PATHS[notebook].stem)


def flat(value) -> list[np.ndarray]:
    """A tensor, array, number, tuple or list of these, as a list of arrays."""
    if isinstance(value, tuple):
        return [array for part in value for array in flat(part)]
    return [value.detach().numpy() if isinstance(value, torch.Tensor) else np.asarray(value)]


@pytest.mark.parametrize(
    "notebook, name", [pytest.param(n, f, id=f"{n}-{f}") for n in TWINS for f in TWINS[n]]
)
def test_the_notebooks_version_agrees_with_the_library(notebook, name):
    twin = TWINS[notebook][name]
    assert name in names(notebook), f"no cell of notebook {notebook} tagged `twin` defines {name}"
    mine = flat(names(notebook)[name](*twin.arguments()))
    library = flat(twin.library(*twin.arguments()))
    assert len(mine) == len(library)
    for got, wanted in zip(mine, library, strict=True):
        np.testing.assert_allclose(got, wanted, atol=twin.atol, rtol=twin.rtol)


@pytest.mark.parametrize("notebook", PATHS)
def test_every_notebook_with_twin_cells_is_in_the_table(notebook):
    cells = notebook_cells.code(notebook_cells.read(PATHS[notebook]), "twin")
    assert bool(cells) == (notebook in TWINS), (
        "tests/helpers/twins_table.py and the cells tagged `twin` do not match"
    )
