"""environment.yml, pyproject.toml and constraints.txt say the same; CITATION.cff, too."""

import re
import tomllib
from pathlib import Path

import yaml

import motiondiff_edu

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def pins() -> dict[str, str]:
    lines = [
        line.split("#")[0].strip()
        for line in (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    ]
    return dict(line.lower().split("==") for line in lines if line)


def test_environment_installs_the_package_and_has_no_second_list():
    content = yaml.safe_load((ROOT / "environment.yml").read_text(encoding="utf-8"))
    assert content["name"] == PROJECT["name"] and content["channels"] == ["conda-forge"]
    assert content["dependencies"] == [
        f"python{PROJECT['requires-python']}",
        "pip",
        {"pip": ["-c constraints.txt", "-e ."]},
    ]


def test_every_requirement_is_pinned_within_its_bound():
    lines = PROJECT["dependencies"] + [
        line for lines in PROJECT["optional-dependencies"].values() for line in lines
    ]
    for line in lines:
        name, bound = re.fullmatch(r"([\w-]+)>=([\d.]+)", line).groups()
        pinned = pins()[name.lower()]
        assert [int(n) for n in pinned.split(".")[:3]] >= [int(n) for n in bound.split(".")], (
            f"{line}, pinned {pinned}"
        )


def test_torch_is_pinned_exactly():
    assert pins()["torch"] == "2.13.0"


def test_a_student_gets_jupyterlab_and_not_the_test_tools():
    names = {re.match(r"[\w-]+", line)[0] for line in PROJECT["dependencies"]}
    assert {"jupyterlab", "ipywidgets", "anywidget"} <= names
    assert not names & {"pytest", "nbmake", "playwright", "beartype", "ruff"}


def test_the_workflow_runs_the_oldest_python_that_is_promised():
    workflow = yaml.safe_load((ROOT / ".github/workflows/test.yml").read_text(encoding="utf-8"))
    job = workflow["jobs"]["test"]
    assert job["strategy"]["matrix"]["python"][0] == PROJECT["requires-python"].removeprefix(">=")
    assert ".ci/run" in [step.get("run") for step in job["steps"]]


def test_citation_and_changelog_know_the_version():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert str(citation["version"]) == motiondiff_edu.__version__
    assert f"## {motiondiff_edu.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
