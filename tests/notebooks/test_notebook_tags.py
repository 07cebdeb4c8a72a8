"""`Notebook: NN` in a docstring is true: the notebook names what it is said to use."""

import ast

import notebook_tags


def test_a_tag_names_a_notebook_that_uses_what_it_describes():
    """`python tools/notebook_tags.py --mend` takes the wrong ones out."""
    assert notebook_tags.wrong_tags() == []


WRONG = '''"""A file.  Notebook: 02, 77"""


def q_sample(x):
    """Noise.

    Notebook: 02
    """


class Nowhere:
    """One sentence.   Notebook: 02, 03

    Raises nothing.
    """

    def posterior(self):
        """Another. Notebook:
        03, 04"""


def unheard_of():
    """Nothing.
    Source: ours.  Notebook: 04
    """
'''


def test_wrong_numbers_are_taken_out_and_right_ones_stay(tmp_path, monkeypatch):
    texts = {  # all of the notebook, and what of it is code
        "02": ("ddpm.q_sample(x)", "ddpm.q_sample(x)"),
        "03": ("the `posterior`; unheard_of", "`posterior`"),
        "04": ("a posterior, written as prose", ""),
    }
    monkeypatch.setattr(notebook_tags, "texts_of", lambda number: texts.get(number, ("", "")))
    path = tmp_path / "noise.py"
    path.write_text(WRONG)
    wrong = [(name, numbers) for name, _, numbers in notebook_tags.wrong_in(path)]
    assert sorted(wrong) == [
        ("Nowhere", ["02", "03"]),
        ("noise", ["77"]),
        ("posterior", ["04"]),
        ("unheard_of", ["04"]),
    ]
    notebook_tags.mend(path)
    assert notebook_tags.wrong_in(path) == []
    tree = ast.parse(path.read_text())
    said = {
        getattr(n, "name", "file"): ast.get_docstring(n)
        for n in ast.walk(tree)
        if hasattr(n, "body")
    }
    assert said["file"] == "A file.  Notebook: 02" and said["q_sample"] == "Noise.\n\nNotebook: 02"
    assert said["Nowhere"] == "One sentence.\n\nRaises nothing."
    assert said["posterior"] == "Another. Notebook: 03"
    assert said["unheard_of"] == "Nothing.\nSource: ours."
