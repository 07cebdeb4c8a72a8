"""tools/library_mutants: each of the forty mistakes can be made, and has its tests."""

import re

import pytest

from tools import library_mutants
from tools.library_mutants import MUTANTS, QUICK, Mutant, folder_copied, killed

PACKAGE = library_mutants.ROOT / "motiondiff_edu"


def quick() -> list[str]:
    return QUICK.read_text(encoding="utf-8").split()


def test_there_are_forty_and_all_are_different():
    assert len(MUTANTS) == len({(one.file, one.old, one.new) for one in MUTANTS}) == 40


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda one: f"{one.file}:{one.new.strip()[:30]}")
def test_each_can_be_applied_and_has_its_tests_in_the_quick_run(mutant):
    text = (PACKAGE / mutant.file).read_text(encoding="utf-8")
    changed = mutant.applied(text)
    assert changed != text
    compile(changed, mutant.file, "exec")
    assert mutant.test_file in quick()


def test_the_quick_run_names_what_there_is_and_nothing_twice(root):
    files = [name.partition("::")[0] for name in quick()]
    assert len(files) == len(set(files))
    assert [name for name in files if not (root / name).is_file()] == []


def test_a_mutant_that_is_not_there_once_is_told():
    with pytest.raises(ValueError, match=r"ddpm.py has 'x_s = ' 0 times, not once"):
        Mutant("ddpm.py", "x_s = ", "").applied("x_t = 1")


def test_a_mutant_is_put_into_the_copy_and_taken_out_again(tmp_path, root, monkeypatch):
    folder_copied(tmp_path)
    changed = tmp_path / "motiondiff_edu" / "_files.py"
    seen = []

    def failed(copy, tests):
        seen.append((copy, tests, changed.read_text(encoding="utf-8").count("1 / 0")))
        return True

    monkeypatch.setattr(library_mutants, "failed", failed)
    assert killed(Mutant("_files.py", "sorted(texts.items())", "1 / 0"), tmp_path, ["tests/a.py"])
    original = root / "motiondiff_edu" / "_files.py"
    assert seen == [(tmp_path, ["tests/a.py"], 1)] and changed.resolve() == original.resolve()
    assert "1 / 0" not in original.read_text(encoding="utf-8")
    assert (tmp_path / "tests" / "conftest.py").is_file() and (
        tmp_path / "pyproject.toml"
    ).is_file()


def test_contributing_says_how_many_there_are(root):
    text = (root / "docs" / "CONTRIBUTING.md").read_text(encoding="utf-8")
    ((dead, all_of_them),) = re.findall(r"kills (\d+) of (\d+)", text)
    assert int(all_of_them) == len(MUTANTS) and int(dead) <= len(MUTANTS)
