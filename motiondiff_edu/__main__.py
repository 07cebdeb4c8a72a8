"""`python -m motiondiff_edu lab | demo NB | doctor`: open the course, show one notebook, or ask
what works here.

Further options go to JupyterLab: `python -m motiondiff_edu lab --no-browser --port 8899`.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from . import _commands

PACKAGE = Path(__file__).parent
# what a projector wants: matplotlib's type, and JupyterLab's
LARGE_FIGURES = "figure.dpi: 150\nfont.size: 13\nlines.linewidth: 2.2\n"
LARGE_TYPE = {
    "overrides": {"code-font-size": "19px", "content-font-size1": "21px", "ui-font-size1": "17px"}
}
QUIET = {"fetchNews": "false", "checkForUpdates": False}


class NotebookError(ValueError):
    """A notebook that is not there, with those that are."""


def notebook_folder() -> Path:
    """notebooks/ of the checkout, or the ones that came with the wheel."""
    checkout = PACKAGE.parent / "notebooks"
    return (
        checkout
        if checkout.is_dir() and (PACKAGE.parent / "pyproject.toml").is_file()
        else PACKAGE / "notebooks"
    )


def find(folder: Path, number: str) -> Path:
    """The notebook of that number. Raises NotebookError with the numbers there are."""
    there = sorted(folder.glob("[0-9][0-9]*.ipynb"))
    wanted = [path for path in there if path.name[:2] == number.zfill(2)]
    if not wanted:
        numbers = ", ".join(path.name[:2] for path in there) or "none"
        raise NotebookError(f"no notebook {number} in {folder}; there are: {numbers}")
    return wanted[0]


def place_for_students(folder: Path) -> tuple[Path, Path]:
    """Where JupyterLab starts, and the student edition below it.

    In a checkout, the edition as it lies there. From a wheel, a copy in ./motiondiff_notebooks,
    because nobody should write into an installed package; what the reader has there already is
    kept.
    """
    if folder.parent != PACKAGE:
        return folder.parent, folder / "student"
    mine = Path.cwd() / "motiondiff_notebooks"
    mine.mkdir(exist_ok=True)
    for path in (folder / "student").glob("*.ipynb"):
        if not (mine / path.name).exists():
            shutil.copy(path, mine / path.name)
    return mine, mine


def place_for_demo(folder: Path, home: Path) -> Path:
    """A copy of the notebooks, and of the pictures in docs/, to show: the sources stay as they
    are."""
    target = home / "notebooks"
    shutil.copytree(folder, target, ignore=shutil.ignore_patterns("student", ".ipynb_checkpoints"))
    if folder.parent != PACKAGE and (folder.parent / "docs").is_dir():
        shutil.copytree(folder.parent / "docs", home / "docs")
    return target


def demo_environment(home: Path) -> dict[str, str]:
    """What makes a notebook ready to show: MOTIONDIFF_DEMO for runtime, large type in figures and
    in JupyterLab."""
    folder = home / "settings" / "@jupyterlab" / "apputils-extension"
    folder.mkdir(parents=True)
    (folder / "themes.jupyterlab-settings").write_text(json.dumps(LARGE_TYPE))
    (folder / "notification.jupyterlab-settings").write_text(json.dumps(QUIET))
    (home / "matplotlibrc").write_text(LARGE_FIGURES)
    settings = {"JUPYTERLAB_SETTINGS_DIR": home / "settings", "MATPLOTLIBRC": home / "matplotlibrc"}
    return {"MOTIONDIFF_DEMO": "1"} | {name: str(path) for name, path in settings.items()}


def open_lab(
    root: Path, notebook: Path, options: list[str], environment: dict[str, str] | None = None
) -> int:
    """Start JupyterLab in `root` with `notebook` open; returns its exit status."""
    address = "/lab/tree/" + notebook.relative_to(root).as_posix()
    command = [
        sys.executable,
        "-m",
        "jupyterlab",
        f"--ServerApp.root_dir={root}",
        f"--LabApp.default_url={address}",
    ]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        command.append(
            "--allow-root"
        )  # in a container everyone is root, and JupyterLab would refuse
    print(f"opening {notebook.name} in {root} (stop with Ctrl-C)", flush=True)
    return serve([*command, *options], environment or {})


def serve(command: list[str], environment: dict[str, str]) -> int:
    """Run the server; its exit status. Ctrl-C and SIGTERM end it in good order, so that no kernel
    is left behind."""
    server = subprocess.Popen(command, env=os.environ | environment)
    before = signal.signal(signal.SIGTERM, lambda *_: server.terminate())
    try:
        return server.wait()
    except KeyboardInterrupt:
        server.terminate()
        server.wait()
        return 0
    finally:
        signal.signal(signal.SIGTERM, before)


def lab(options: list[str]) -> int:
    """JupyterLab at notebook 00 of the student edition."""
    root, edition = place_for_students(notebook_folder())
    return open_lab(root, find(edition, "00"), options)


def demo(number: str, options: list[str]) -> int:
    """JupyterLab at one notebook, solutions included, large, with shipped weights; changes are not
    kept."""
    find(notebook_folder(), number)
    with tempfile.TemporaryDirectory(
        prefix="motiondiff_demo_", ignore_cleanup_errors=True
    ) as folder:
        home = Path(folder).resolve()
        notebook = find(place_for_demo(notebook_folder(), home), number)
        print("a copy to show: what you change in it is not kept")
        return open_lab(home, notebook, options, demo_environment(home))


def main(arguments: list[str] | None = None) -> int:
    """python -m motiondiff_edu lab | demo NB | doctor; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m motiondiff_edu", description=__doc__.splitlines()[0]
    )
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("lab", help="open JupyterLab at notebook 00")
    commands.add_parser("demo", help="open one notebook ready to show").add_argument(
        "number", metavar="NB"
    )
    commands.add_parser("doctor", help="what works here, and what to do about the rest")
    _commands.add_to(commands)
    chosen, options = parser.parse_known_args(arguments)
    if chosen.command in _commands.VERBS:
        if options:
            parser.error(f"{chosen.command} does not know {' '.join(options)}")
        return _commands.run(chosen)
    if options and chosen.command == "doctor":
        parser.error(f"doctor takes no options, got {' '.join(options)}")
    try:
        if chosen.command == "lab":
            return lab(options)
        if chosen.command == "demo":
            return demo(chosen.number, options)
    except NotebookError as error:
        print(error, file=sys.stderr)
        return 1
    from . import doctor

    return doctor.main()


if __name__ == "__main__":
    sys.exit(main())
