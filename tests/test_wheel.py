"""A wheel, built and installed elsewhere, has all that the checkout has.

Weights, ES module, data_synth, notebooks.
"""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import links
import pytest

from motiondiff_edu.widgets import module

ROOT = Path(__file__).parent.parent
BUILT_FROM = [
    "pyproject.toml",
    "setup.py",
    "MANIFEST.in",
    "README.md",
    "LICENSE",
    "constraints.txt",
]
FOLDERS = ["motiondiff_edu", "data_synth", "notebooks", "docs"]
SHIPPED = {".py", ".js", ".css", ".safetensors", ".json", ".typed"}

# What a user of the installed wheel does, far from any checkout.
USE = """
import json, sys
import motiondiff_edu, data_synth
from pathlib import Path
from motiondiff_edu.course import checks, copies, doctor, places
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.widgets.player import Player
from data_synth import mixtures
import numpy as np

models = {n: checkpoints.load(n).model for n in checkpoints.available()}
walkers = {n: sum(p.numel() for p in model.parameters()) for n, model in models.items()}
player = Player(np.zeros((2, 21, 3)))
root, mine = places.place_for_students()
copies.hand_out(places.notebook_folder(), mine)
print(json.dumps({
    "package": motiondiff_edu.__file__, "data": data_synth.__file__,
    "version": motiondiff_edu.__version__,
    "walkers": walkers, "module": len(str(player._esm)), "pins": len(doctor.constraints()),
    "notebooks": sorted(p.name for p in (places.notebook_folder() / "student").glob("*.ipynb")),
    "place": [str(root), str(mine)],
}))
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """Built from a copy of the files, so that the checkout stays clean."""
    folder = tmp_path_factory.mktemp("source")
    for name in BUILT_FROM:
        shutil.copy(ROOT / name, folder / name)
    for name in FOLDERS:
        shutil.copytree(
            ROOT / name,
            folder / name,
            ignore=shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints"),
        )
    build = [
        "wheel",
        "--quiet",
        "--no-deps",
        "--no-build-isolation",
        "-w",
        str(folder / "dist"),
        str(folder),
    ]
    subprocess.run([sys.executable, "-m", "pip", *build], check=True, capture_output=True)
    (built,) = (folder / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def elsewhere(wheel, tmp_path_factory) -> tuple[Path, dict]:
    """A fresh environment with the wheel in it; torch and the others are borrowed.

    With what USE prints.
    """
    home = tmp_path_factory.mktemp("elsewhere")
    venv.create(home / "env", with_pip=False)
    python = home / "env" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    install = ["--python", str(python), "install", "--quiet", "--no-deps", "--no-index", str(wheel)]
    subprocess.run([sys.executable, "-m", "pip", *install], check=True, capture_output=True)
    find = "import sysconfig; print(sysconfig.get_path('purelib'))"
    site = subprocess.run(
        [python, "-I", "-c", find], check=True, capture_output=True, text=True
    ).stdout.strip()
    # a path in a .pth file is searched last, and the .pth files there (an editable install) are not
    # read
    Path(site, "borrowed.pth").write_text(sysconfig.get_path("purelib") + "\n")
    answer = subprocess.run([python, "-I", "-c", USE], cwd=home, capture_output=True, text=True)
    assert answer.returncode == 0, answer.stderr
    return home, json.loads(answer.stdout.splitlines()[-1])


def test_the_wheel_holds_every_file_of_the_packages(wheel):
    held = set(zipfile.ZipFile(wheel).namelist())
    wanted = {
        path.relative_to(ROOT).as_posix()
        for folder in ("motiondiff_edu", "data_synth")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in SHIPPED and "__pycache__" not in path.parts
    }
    assert wanted - held == set()
    tops = {name.split("/")[0] for name in held}
    assert {top for top in tops if not top.endswith(".dist-info")} == {
        "motiondiff_edu",
        "data_synth",
    }


def test_the_installed_package_is_the_wheels(elsewhere):
    home, found = elsewhere
    assert Path(found["package"]).is_relative_to(home) and Path(found["data"]).is_relative_to(home)


def test_weights_and_es_module_are_found(elsewhere):
    _, found = elsewhere
    shipped = {path.stem for path in (ROOT / "motiondiff_edu" / "pretrained").glob("*.safetensors")}
    assert shipped <= set(found["walkers"]) and all(found["walkers"].values())
    assert found["module"] == len(module.es_module()) > 20_000


def test_lab_opens_a_copy_of_the_wheels_notebooks(elsewhere):
    home, found = elsewhere
    there = sorted(path.name for path in (ROOT / "notebooks" / "student").glob("*.ipynb"))
    assert found["notebooks"] == there and found["pins"] > 30
    mine = home.resolve() / "motiondiff_notebooks"
    assert [Path(place).resolve() for place in found["place"]] == [mine, mine]
    assert sorted(path.name for path in mine.glob("*.ipynb")) == there
    assert links.dead(mine) == []


def test_the_wheel_brings_its_command(elsewhere):
    home, _ = elsewhere
    script = (
        home / "env" / ("Scripts/motiondiff-edu.exe" if os.name == "nt" else "bin/motiondiff-edu")
    )
    answer = subprocess.run([script, "demo", "99"], cwd=home, capture_output=True, text=True)
    assert answer.returncode == 1 and answer.stderr.startswith("demo: no notebook 99 in ")
    told = subprocess.run(
        [script, "lab", "--help"], cwd=home, capture_output=True, text=True
    ).stdout
    assert "usage: motiondiff-edu lab" in told and "example: motiondiff-edu lab" in told
