"""tools/backed_numbers.py: what an answer says was printed before it."""

import json
import subprocess
import sys

import pytest
from backed_numbers import claims, numbers, printed, settings, unbacked


def answer(text):
    source = f"<details><summary>What happened</summary>\n\n{text}\n</details>\n\n0.77 of it"
    return {"cell_type": "markdown", "source": source}


def code(source, *outputs):
    return {"cell_type": "code", "source": source, "outputs": list(outputs)}


def out(text):
    return {"output_type": "stream", "name": "stdout", "text": [text]}


def told(text):
    return [(claim.text, claim.unit) for claim in claims(text)]


@pytest.mark.parametrize(
    "text, wanted",
    [
        ("(c): 60 % of it, and three hills.", [("60", "%")]),
        ("It is 0.25, or .25, in 3 cells.", [("0.25", ""), (".25", "")]),
        ("1,200 m and −3.5 cm; 16 ms.", [("1,200", "m"), ("−3.5", "cm"), ("16", "ms")]),
        ("at $s = 0.3$, `0.4`, [x](a0.5.md), notebook 02", []),
        ("step 2 costs more than a nat; T_2, x0.5", []),
    ],
)
def test_claims_are_decimals_and_numbers_with_a_unit(text, wanted):
    assert told(text) == wanted


def test_numbers_of_a_printed_text():
    assert numbers("bones  5.02 cm, -1.5e-3 of 1,200 (.5)") == {5.02, -0.0015, 1200.0, 0.5}


def test_settings_are_the_numbers_of_the_code():
    assert settings("%matplotlib inline\nx = f(0.5, n=3)  # 0.9\ny = 'of 7'") == {0.5, 3.0}


@pytest.mark.parametrize(
    "text, shown, backed",
    [
        ("It is 0.32.", "0.3164", True),
        ("It is 0.32.", "0.334", False),
        ("It is 32 %.", "share 0.321", True),
        ("It is 8 cm.", "0.082 m", True),
        ("It is 8 cm.", "0.092 m", False),
        ("It is about 30 %.", "0.26", True),
        ("It is 30 %.", "0.26", False),
        ("It is −0.5.", "-0.49", True),
        ("It is 1,200 m.", "1200 m", True),
    ],
)
def test_a_claim_is_backed_by_what_rounds_to_it(text, shown, backed):
    cells = [code("f()", out(shown)), answer(text)]
    assert (unbacked({"cells": cells}) == []) is backed


def test_what_comes_later_backs_nothing_and_settings_do():
    late = {"cells": [answer("It is 0.32."), code("f()", out("0.32"))]}
    assert unbacked(late) == ["cell 0: 0.32"]
    assert unbacked({"cells": [code("f(rate=0.32)"), answer("It is 0.32.")]}) == []


def test_captions_pictures_and_what_is_drawn_count_and_their_data_do_not():
    page = '<img alt="at 0.11" src="data:0.99"><figcaption style="x">ends at 0.22</figcaption>'
    data = {"text/html": page, "image/png": "0.88", "text/plain": "0.33"}
    output = {"output_type": "display_data", "data": data, "metadata": {"texts": "row 0.44"}}
    assert numbers(printed(output)) == {0.11, 0.22, 0.33, 0.44}


def test_what_follows_from_printed_numbers_is_backed():
    told = "The stride is 15 % short.<!-- 15 % = 100 * (1 - 0.85) -->"
    assert unbacked({"cells": [code("f('0.85')"), answer(told)]}) == []
    assert unbacked({"cells": [code("f(0.8)"), answer(told)]}) == ["cell 1: 15 %"]
    wrong = "The stride is 16 % short.<!-- 16 % = 100 * (1 - 0.85) -->"
    assert unbacked({"cells": [code("f(0.85)"), answer(wrong)]}) == ["cell 1: 16 %"]


def test_a_comment_computes_and_does_nothing_else():
    told = answer("It is 0.5.<!-- 0.5 = print(0.5) -->")
    with pytest.raises(ValueError, match="only numbers and"):
        unbacked({"cells": [code("f(0.5)"), told]})


def test_a_figure_is_backed_by_the_record_that_it_names_and_by_no_other():
    told = {"cells": [answer("0.21 beside 0.55<!-- records: dancer.repeat a-b.c -->")]}
    records = {"dancer.repeat": 0.208, "a-b.c": 0.55}
    assert unbacked(told, records) == []
    assert unbacked(told, records | {"a-b.c": 0.4, "other": 0.55}) == ["cell 0: 0.55"]
    with pytest.raises(ValueError, match="no record is called a-b.c"):
        unbacked(told, {"dancer.repeat": 0.208})


def test_text_outside_of_answers_is_not_read():
    assert unbacked({"cells": [{"cell_type": "markdown", "source": "it is 0.7"}]}) == []


def test_the_tool_names_the_place_and_fails(root, tmp_path):
    (tmp_path / "01_a.ipynb").write_text(json.dumps({"cells": [answer("It is 5 cm.")]}))
    command = [sys.executable, root / "tools/backed_numbers.py", tmp_path]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 1 and run.stdout == "01_a.ipynb, cell 0: 5 cm\n"
    (tmp_path / "01_a.ipynb").write_text(json.dumps({"cells": [answer("It is far.")]}))
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0 and "was printed before it" in run.stdout
