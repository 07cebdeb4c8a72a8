"""tools/journey: what is counted of a job, on a package of four small files."""

import importlib
import sys

import pytest

from tools import journey
from tools.journey import (
    Journey,
    code_of,
    missed,
    records_of,
    syllabus,
    syllabus_share,
    traced,
    unproven,
)

FILES = {
    "__init__.py": "",
    "_files.py": "def write():\n    return 1\n",
    "idea.py": """\
def step(x):
    if x > 9:
        return None
    return [y + 1 for y in range(x)]


class Net:
    def forward(self, x):
        for _ in range(5):
            step(x)
        return x
""",
    "around/__init__.py": "",
    "around/verb.py": """\
from functools import wraps

from .. import _files


def loudly(function):
    @wraps(function)
    def called(*given):
        return function(*given)

    return called


@loudly
def generate(x):
    from ..idea import Net

    return Net().forward(x)


def verb(x):
    _files.write()
    return generate(x)


def never():
    return 0
""",
}


@pytest.fixture
def package(tmp_path, monkeypatch):
    """The folder of a package `walks`, which is forgotten afterwards."""
    for name, text in FILES.items():
        path = tmp_path / "walks" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    yield tmp_path / "walks"
    for name in [name for name in sys.modules if name.split(".")[0] == "walks"]:
        del sys.modules[name]


def of_verb(package) -> Journey:
    verb = importlib.import_module("walks.around.verb").verb
    return traced(lambda: verb(3), package, code_of("around.verb.generate", "walks"))


def test_files_functions_and_lines_count_once_and_imports_do_not(package):
    found = of_verb(package)
    names = {code.co_qualname for code in found.functions}
    assert names == {"verb", "write", "loudly.<locals>.called", "generate", "Net.forward", "step"}
    assert {path.rpartition("walks/")[2] for path in found.files} == {
        "_files.py",
        "idea.py",
        "around/verb.py",
    }
    # verb 2, write 1, called 1, generate 2; forward 3 and step 2, however often they run
    assert len(found.lines) == 11
    again = of_verb(package)  # now that idea.py has been imported
    assert again.lines == found.lines


def test_generation_alone_and_its_share_of_the_syllabus(package):
    found = of_verb(package)
    assert syllabus(package) == {str(package / "idea.py")}
    assert len(found.within) == 7  # of generate, forward and step
    assert syllabus_share(found) == 5 / 7
    assert syllabus_share(Journey(package)) == 0


def test_an_error_ends_the_tracing_and_the_part(package):
    before = sys.gettrace()
    verb = importlib.import_module("walks.around.verb").verb
    with pytest.raises(TypeError):
        traced(lambda: verb("a"), package)
    assert sys.gettrace() is before


def test_names_are_looked_up_and_one_that_is_gone_is_missed(package, monkeypatch):
    idea = importlib.import_module("walks.idea")
    assert code_of("idea.Net.forward", "walks") is idea.Net.forward.__code__
    assert code_of("idea.Net.gone", "walks") is None and code_of("gone.f", "walks") is None
    assert code_of("around.verb.generate", "walks").co_name == "generate"  # under its wrapper
    found = {"walk": of_verb(package)}
    taught = {"idea.step": ("walk",), "idea.gone": ("walk",), "around.verb.never": ("walk",)}
    monkeypatch.setattr(journey, "TAUGHT", taught)
    monkeypatch.setattr(journey, "code_of", lambda name: code_of(name, "walks"))
    assert missed(found) == ["idea.gone by walk", "around.verb.never by walk"]


def test_what_is_taught_and_what_generates_exists():
    for name in (*journey.TAUGHT, *journey.GENERATION.values()):
        assert code_of(name), f"{name} is gone: mend the tables at the top of tools/journey.py"


def test_a_departure_is_unproven_without_a_difference_that_is_not_0():
    def record(name, low, high):
        return {"name": name, "low": low, "high": high}

    records = [
        record("sweep.a.bones_minus_base_cm", -1, 2),
        record("sweep.a.feet_minus_base_mps", 0.1, 0.2),
        record("sweep.b.bones_minus_base_cm", -1, 2),
        record("sweep.c.bones_cm", -1, 2),
    ]
    texts = {
        "gains": "Gain: `sweep.a.*`",
        "nothing": "Gain: `sweep.b.*` and `sweep.c.*`",
        "other": "Gain: `sweep.c.*`: it is nearer, and no gain in steps",
        "said": "An idea.\nGain: docs, `sweep.a.*`. No gain\nis shown.",
        "later": "Gain: not measured yet; it will be `sweep.a.*`",
    }
    assert list(unproven(texts, records)) == ["nothing", "said", "later"]


def test_the_records_have_their_names(package):
    found = of_verb(package)
    names = ("walk", "dance", "inbetween", "recipe", "dancer_recipe")
    made = {one["name"]: one["value"] for one in records_of(dict.fromkeys(names, found))}
    assert made["plain.walk_files"] == 3 and made["plain.recipe_functions"] == 6
    assert made["plain.dance_lines"] == 11 and made["plain.walk_syllabus_share"] == 5 / 7
    assert made["plain.taught_lines_hit"] == 0 and made["plain.unproven"] >= 0
