"""tools/check_notebooks.py finds each fault it claims to find.

This checkout's notebooks have none.
"""

import copy
import json

import check_notebooks
import pytest

OPENING = """# 02 Noise
You will be able to add noise.

**New here:** noise; schedules.

**Needs** 01. **Paper** MoDiff III-B. **Minutes:** 50 in class; not yet timed on students.
**Symbols** x0, x_s, s.

1. (01) What are bones?

<details><summary>Answers</summary>

1. Constant.
</details>"""
CLOSING = "Three things to keep. **Questions for the room:** a? b? c? **Seeds:** 0. Next: 03."
IMPORTS = """from motiondiff_edu import checks, runtime
run = runtime.start(notebook="02", seed=0)"""
EXERCISE = """**Exercise** (difficulty 1 of 3, 5 minutes)
<details><summary>Hint</summary>
square roots
</details>"""
SOLUTION = "def f(x):\n    # solution\n    return x\n    # end solution\n\n\nchecks.f(f)"


def cell(source, *tags, kind="code"):
    body = {"cell_type": kind, "metadata": {"tags": list(tags)}, "source": source}
    return body | ({"outputs": [], "execution_count": None} if kind == "code" else {})


@pytest.fixture
def good():
    text = [
        cell(f"Some words. {'**Predict** more or less?' if i < 2 else ''}", kind="markdown")
        for i in range(9)
    ]
    cells = [
        cell(OPENING, kind="markdown"),
        cell(IMPORTS, "imports"),
        cell("def twin(x):\n    return x", "twin"),
        *[part for words in text for part in (words, cell("x = 1"))],
        *[
            part
            for _ in range(2)
            for part in (cell(EXERCISE, kind="markdown"), cell(SOLUTION, "solution"))
        ],
        cell(CLOSING, kind="markdown"),
    ]
    for number, each in enumerate(cells):
        each["id"] = f"c{number}"
    return {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


def faults(notebook, tmp_path, name="02_noise.ipynb"):
    path = tmp_path / name
    path.write_text(json.dumps(notebook))
    return check_notebooks.faults(path)


def test_a_good_notebook_has_no_fault(good, tmp_path):
    assert faults(good, tmp_path) == []


def test_a_wrapped_statement_counts_once_and_imports_not_at_all(good, tmp_path):
    wrapped = "\n".join(f"x{i} = [\n    {i},\n]" for i in range(8))
    for one in good["cells"][4:12:2]:
        one["source"] = wrapped
    first(good, "imports")["source"] += "\nx = 1" * 20
    assert faults(good, tmp_path) == []


def test_what_is_extra_counts_apart(good, tmp_path):
    good["cells"][5]["source"] = "*(extra)* Some words." + " word" * 480
    extra(good, 5, 6)
    good["cells"][7]["source"] = "**Predict** more?" + " word" * 1600
    good["cells"] += [dict(good["cells"][4], id=f"more-{k}") for k in range(20)]
    good["cells"].append(good["cells"].pop(-21))
    assert faults(good, tmp_path) == []


def first(notebook, tag):
    return next(c for c in notebook["cells"] if tag in c["metadata"]["tags"])


def spoil_outputs(nb):
    nb["cells"][1]["outputs"] = [{"output_type": "stream"}]


def spoil_few_cells(nb):
    del nb["cells"][8:12]


def spoil_words(nb):
    nb["cells"][0]["source"] += " word" * 1800


def spoil_long_cell(nb):
    first(nb, "twin")["source"] = "\n".join(f"x = {i}" for i in range(17))


def spoil_share(nb):
    for one in nb["cells"][4:10:2]:
        one["source"] = "\n".join(f"x = {i}" for i in range(9))


def spoil_rows(nb):
    first(nb, "twin")["source"] = "x = [\n" + "    0,\n" * 31 + "]"


def spoil_width(nb):
    first(nb, "twin")["source"] = "x = 1\n\nlonger = " + "1" * 80


def spoil_ids(nb):
    nb["cells"][3]["id"] = nb["cells"][4]["id"]


def spoil_twin(nb):
    first(nb, "twin")["metadata"]["tags"] = []


def spoil_prediction(nb):
    nb["cells"][3]["source"] = "Some words."


def spoil_start(nb):
    first(nb, "imports")["source"] = "import torch"


def spoil_import(nb):
    nb["cells"][4]["source"] = "import torch"


def spoil_minutes(nb):
    nb["cells"][0]["source"] = OPENING.replace("; not yet timed on students", "")


def spoil_ideas(nb):
    nb["cells"][0]["source"] = OPENING.replace("noise; schedules", "a; b; c; d")


def spoil_no_ideas(nb):
    nb["cells"][0]["source"] = OPENING.replace("**New here:** noise; schedules.", "")


def spoil_asked(nb):
    nb["cells"][0]["source"] = OPENING.replace("(01)", "(00)")


def spoil_answers(nb):
    nb["cells"][0]["source"] = OPENING.replace("1. Constant.", "")


def extra(nb, *indices):
    for index in indices:
        nb["cells"][index]["metadata"]["tags"].append("extra")


def spoil_extra_unsaid(nb):
    extra(nb, 5, 6)


def spoil_extra_code_first(nb):
    extra(nb, 6)
    nb["cells"][6]["source"] = "x = 1  # (extra)"


def spoil_extra_untagged(nb):
    nb["cells"][5]["source"] = "*(extra)* Some words."


def spoil_extra_words(nb):
    extra(nb, 5)
    nb["cells"][5]["source"] = "*(extra)*" + " word" * 500


def spoil_extra_cells(nb):
    for index in range(3, 16):
        extra(nb, index)
    nb["cells"][3]["source"] = "*(extra)* Some words."


def spoil_closing(nb):
    nb["cells"][-1]["source"] = "The end."


def spoil_room(nb):
    nb["cells"][-1]["source"] = CLOSING.replace("c?", "c.")


def spoil_seeds(nb):
    nb["cells"][-1]["source"] = CLOSING.replace("**Seeds:** 0.", "\n\n**More**")


def spoil_exercises(nb):
    first(nb, "solution")["metadata"]["tags"] = []


def spoil_difficulty(nb):
    where = nb["cells"].index(first(nb, "solution"))
    nb["cells"][where - 1]["source"] = EXERCISE.replace("difficulty 1 of 3, ", "")


def spoil_hint(nb):
    where = nb["cells"].index(first(nb, "solution"))
    nb["cells"][where - 1]["source"] = EXERCISE.replace("Hint", "Idea")


def spoil_check(nb):
    first(nb, "solution")["source"] = SOLUTION.replace("checks.f(f)", "f(1)")


def spoil_markers(nb):
    first(nb, "solution")["source"] = SOLUTION.replace("    # end solution\n", "")


def spoil_by_using_an_exercise(nb):
    nb["cells"][4]["source"] = "def again(x):\n    return f(x) + 1"


def spoil_by_using_an_answer(nb):
    first(nb, "solution")["source"] += "\nanswer, _ = f((1, 2))"
    nb["cells"][4]["source"] = "x = [answer for _ in range(3)]"


def spoil_by_using_the_exercise_before(nb):
    nb["cells"][-2]["source"] = SOLUTION.replace("f(x)", "g(x)").replace("x\n", "f(x)\n")


def spoil_by_using_an_extra(nb):
    nb["cells"][4]["source"], nb["cells"][4]["metadata"]["tags"] = "z = 1", ["extra"]
    nb["cells"][6]["source"] = "def g(y):\n    return [z + y for y in range(3)]"


def spoil_by_using_the_later_of_two(nb):
    nb["cells"][4]["source"] = nb["cells"][6]["source"] = "z = 1"
    nb["cells"][6]["metadata"]["tags"] = ["extra"]
    nb["cells"][8]["source"] = "print(z)"


def spoil_pip(nb):
    nb["cells"][4]["source"] = "%pip install torch"


def spoil_path(nb):
    nb["cells"][4]["source"] = "x = open('" + "/home" + "/me/walk.bvh')"


def spoil_image(nb):
    nb["cells"][3]["source"] += "\n![](walk.png)"


@pytest.mark.parametrize(
    "spoil, words",
    [
        (spoil_outputs, "outputs are stored"),
        (spoil_few_cells, "22 cells"),
        (spoil_words, "words; keep under"),
        (spoil_long_cell, "a code cell of 17 lines"),
        (spoil_share, "more than 8 lines"),
        (spoil_rows, "a code cell of 33 rows"),
        (spoil_width, "cell c2, line 3 has 89 columns"),
        (spoil_ids, "ids are missing or repeated"),
        (spoil_twin, "tagged `twin`"),
        (spoil_prediction, "1 times **Predict**"),
        (spoil_start, "runtime.start"),
        (spoil_import, "all imports belong"),
        (spoil_minutes, "does not say its minutes"),
        (spoil_ideas, "4 new ideas"),
        (spoil_no_ideas, "0 new ideas"),
        (spoil_asked, "it should from ['01']"),
        (spoil_answers, "0 folded answers to 1 questions"),
        (spoil_extra_unsaid, "cell c5 begins what is extra"),
        (spoil_extra_code_first, "cell c6 begins what is extra"),
        (spoil_extra_untagged, "cell c5 says (extra)"),
        (spoil_extra_words, "501 words in extra cells"),
        (spoil_extra_cells, "13 extra cells"),
        (spoil_closing, "does not say three things"),
        (spoil_room, "2 questions for the room"),
        (spoil_seeds, "no **Seeds**"),
        (spoil_exercises, "1 cells tagged `solution`"),
        (spoil_difficulty, "minutes and difficulty"),
        (spoil_hint, "fold a hint"),
        (spoil_check, "must call its check"),
        (spoil_markers, "needs `# solution`"),
        (spoil_by_using_an_exercise, "cell c4 uses f of an exercise"),
        (spoil_by_using_an_answer, "cell c4 uses answer of an exercise"),
        (spoil_by_using_the_exercise_before, "cell c24 uses f of an exercise"),
        (spoil_by_using_an_extra, "cell c6 uses z of an extra cell"),
        (spoil_by_using_the_later_of_two, "cell c8 uses z of an extra cell"),
        (spoil_pip, "pip in a code cell"),
        (spoil_path, "an absolute path"),
        (spoil_image, "without alt text"),
    ],
)
def test_each_fault_is_found(good, tmp_path, spoil, words):
    notebook = copy.deepcopy(good)
    spoil(notebook)
    assert any(words in fault for fault in faults(notebook, tmp_path)), faults(notebook, tmp_path)


def test_local_names_and_those_defined_again_are_not_of_an_extra_cell(good, tmp_path):
    good["cells"][3]["source"] = "More (extra)"
    good["cells"][3]["metadata"]["tags"] = good["cells"][4]["metadata"]["tags"] = ["extra"]
    good["cells"][4]["source"] = "z = k = 1"
    good["cells"][6]["source"] = "def g(z):\n    return [z * k for k in range(3)]"
    good["cells"][8]["source"] = "z = 2\nprint(z)"
    good["cells"][10]["source"] = "print(z)"
    assert not [fault for fault in faults(good, tmp_path) if "extra cell" in fault]
