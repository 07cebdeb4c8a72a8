"""`motiondiff-edu doctor`: one page that says what works on this machine.

It also says what to do about the rest.
"""

import argparse
import importlib
import importlib.metadata
import importlib.util
import io
import os
import re
import subprocess
import sys
import tempfile
import webbrowser
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ..widgets import module
from .places import PACKAGE, command_for_lab, notebook_folder, place_for_students, program

HELP = "say on one page what works here, and what to do about the rest"
EXAMPLE = "doctor"
PARTS = dict.fromkeys((*module.PARTS, *module.EDITOR, *module.BENCH, *module.PATH))
ES_MODULES = tuple(f"js/{name}.js" for name in PARTS)
INSTALL = "python -m pip install -c constraints.txt -e . (in the checkout), or make lab"


@dataclass(frozen=True)
class Finding:
    """One line of the page; `remedy` is empty when nothing is wrong.

    A note is worth knowing, but it is no failure.
    """

    name: str
    detail: str
    remedy: str = ""
    note: bool = False

    def __str__(self) -> str:
        mark = "ok  " if not self.remedy else "note" if self.note else "FAIL"
        return f"{mark}  {self.name:<9} {self.detail}" + (
            f"\n{'':16}-> {self.remedy}" if self.remedy else ""
        )


def python() -> Finding:
    """Python itself: 3.11 or newer."""
    detail = f"{sys.version.split()[0]} at {sys.executable}"
    return Finding(
        "python",
        detail,
        "" if sys.version_info >= (3, 11) else "install Python 3.11 or newer, then make lab",
    )


def constraints() -> dict[str, str]:
    """The pinned versions, from the checkout or from the wheel.

    Empty when there is no such file.
    """
    found = [
        path
        for path in (PACKAGE.parent / "constraints.txt", PACKAGE / "constraints.txt")
        if path.is_file()
    ]
    lines = found[0].read_text(encoding="utf-8").splitlines() if found else []
    pins = (re.match(r"([\w.-]+)==([\w.]+)", line) for line in lines)
    return {pin[1].lower(): pin[2] for pin in pins if pin}


def required_packages() -> list[str]:
    """The packages that the course itself requires."""
    lines = importlib.metadata.requires("motiondiff-edu") or []
    return [
        re.split(r"[^\w.-]", line, maxsplit=1)[0].lower()
        for line in lines
        if "extra ==" not in line
    ]


def versions() -> Finding:
    """The installed versions are those of constraints.txt."""
    try:
        names = required_packages()
    except importlib.metadata.PackageNotFoundError:
        return Finding("versions", "motiondiff-edu is not installed", INSTALL)
    pins = constraints()
    missing = []
    other = []
    for name in names:
        try:
            version = importlib.metadata.version(name).split("+")[0]
        except importlib.metadata.PackageNotFoundError:
            missing.append(name)
            continue
        if version != pins.get(name, version):
            other.append(f"{name} {version} (tested: {pins[name]})")
    if missing:
        return Finding("versions", "missing: " + ", ".join(missing), INSTALL)
    if other:
        return Finding(
            "versions", ", ".join(other), f"usually fine; for the tested ones: {INSTALL}", note=True
        )
    return Finding("versions", f"all {len(names)} packages as in constraints.txt")


def compute() -> Finding:
    """torch computes, with no more threads than cores."""
    import torch

    a = torch.eye(3) * 2
    right = torch.equal(a @ a, torch.eye(3) * 4)
    cores, wanted = os.cpu_count() or 1, torch.get_num_threads()
    gpu = "yes" if torch.cuda.is_available() else "no"
    detail = f"torch {torch.__version__}, {wanted} threads on {cores} cores, GPU: {gpu}"
    if not right:
        return Finding("torch", detail + "; it computed a wrong matrix product", INSTALL)
    if wanted > cores:
        return Finding(
            "torch",
            detail,
            "more threads than cores are slow: set OMP_NUM_THREADS to the number of cores",
            note=True,
        )
    return Finding("torch", detail)


def kernel() -> Finding:
    """A notebook kernel starts, and it is this Python with this package."""
    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel(
        kernel_name="python3", startup_timeout=60, stderr=subprocess.DEVNULL
    )
    try:
        reply = client.execute_interactive("import motiondiff_edu", timeout=60, store_history=False)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    if reply["content"]["status"] == "ok":
        return Finding("kernel", "it starts, and finds motiondiff_edu")
    return Finding(
        "kernel",
        f"it starts, but cannot import motiondiff_edu ({reply['content'].get('evalue')})",
        INSTALL,
    )


def canvas() -> Finding:
    """There is all that a moving figure needs: anywidget, the ES module, and a browser."""
    importlib.import_module("anywidget")
    missing = [name for name in ES_MODULES if not (PACKAGE / "widgets" / name).is_file()]
    if missing:
        words = f"the package lacks ES modules in widgets/: {', '.join(missing)}"
        return Finding("canvas", words, INSTALL)
    try:
        browser = webbrowser.get()
    except webbrowser.Error:
        return Finding(
            "canvas",
            "there is no browser here",
            "open the address that lab prints in a browser elsewhere",
            note=True,
        )
    from ..widgets.browsers import has_a_screen, shut_in

    if not has_a_screen():
        return Finding(
            "canvas",
            "there is no display here, so no browser can open a window",
            "open the address that lab prints in a browser elsewhere",
            note=True,
        )
    if snap := shut_in():
        return Finding(
            "canvas",
            f"{snap} is a snap, which cannot open files in /tmp or in hidden folders",
            "keep the course in a folder whose path has no hidden part; pages of md.play go to "
            "your home folder, and other users of this computer can read the address of your lab",
            note=True,
        )
    return Finding(
        "canvas",
        f"all {len(ES_MODULES)} ES modules; opens in "
        f"{getattr(browser, 'name', 'the default browser')}",
    )


def sound() -> Finding:
    """soundfile writes a sound and reads it back."""
    import numpy as np

    soundfile = importlib.import_module("soundfile")
    file = io.BytesIO()
    soundfile.write(file, np.linspace(-0.5, 0.5, 220), 22050, format="WAV")
    file.seek(0)
    samples, rate = soundfile.read(file)
    if len(samples) == 220 and rate == 22050:
        return Finding("sound", f"soundfile {soundfile.__version__} writes and reads")
    return Finding("sound", "a sound that was written is read back differently", INSTALL)


def hearing() -> Finding:
    """The beat tracker hears beats.

    It runs in a process of its own, since what numba has compiled can make it die
    (`conditions/compiled.py`).
    """
    code = "from motiondiff_edu.conditions.compiled import librosa; print(librosa.__version__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    if done.returncode == 0:
        return Finding("hearing", f"librosa {done.stdout.strip()} tracks beats")
    package = importlib.util.find_spec("librosa")
    if not package:
        return Finding("hearing", "librosa is not installed", INSTALL)
    wrong = (done.stderr.strip().splitlines() or [f"the process died ({done.returncode})"])[-1]
    files = os.path.join(os.path.dirname(package.origin or ""), "**", "__pycache__", "*.nb?")
    remedy = f"remove what numba has compiled, which is made anew at the next use: {files}"
    return Finding("hearing", f"librosa's beat tracker fails: {wrong}", remedy)


def weights() -> Finding:
    """The shipped weights can be read."""
    from ..pretrained.checkpoints import available, load

    if "walker" not in available():
        return Finding(
            "weights",
            "no walker in pretrained/",
            "install again, or type make pretrained (this takes hours)",
        )
    parameters = sum(parameter.numel() for parameter in load("walker").model.parameters())
    return Finding("weights", f"walker, {parameters / 1e6:.1f} million parameters")


def writing() -> Finding:
    """Files can be written where `lab` puts the copies of the notebooks."""
    _, mine = place_for_students()
    here = next(folder for folder in (mine, *mine.parents) if folder.is_dir())
    try:
        with tempfile.TemporaryFile(dir=here):
            return Finding("writing", f"files can be written in {here}")
    except OSError as error:
        remedy = f"start from a folder of your own, or name one: {program()} lab --folder FOLDER"
        return Finding("writing", f"files cannot be written in {here} ({error.strerror})", remedy)


def notebooks() -> Finding:
    """The notebooks are where `lab` looks."""
    folder = notebook_folder()
    count = len(list((folder / "student").glob("[0-9][0-9]*.ipynb")))
    return Finding("notebooks", f"{count} in {folder / 'student'}", "" if count else "make student")


CHECKS = (python, versions, compute, kernel, canvas, sound, hearing, weights, writing, notebooks)


def guarded(check: Callable[[], Finding]) -> Finding:
    """The check's finding; an exception of the check becomes a failure."""
    try:
        return check()
    except Exception as error:
        return Finding(check.__name__, f"{type(error).__name__}: {error}".splitlines()[0], INSTALL)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(chosen: argparse.Namespace) -> int:
    """Print the page; 1 when anything failed."""
    return main()


def main(checks: Iterable[Callable[[], Finding]] = CHECKS) -> int:
    """Print the page; 1 when anything failed."""
    failed = 0
    for check in checks:
        finding = guarded(check)
        failed += bool(finding.remedy) and not finding.note
        print(finding, flush=True)
    print(
        f"\nEverything works. To open the course: {command_for_lab()}"
        if not failed
        else f"\nFailures: {failed}. The arrows above say what to do."
    )
    return int(failed > 0)
