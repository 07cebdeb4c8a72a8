"""Who imports whom: core (torch) -> the rest -> viz (matplotlib) -> widgets (ipywidgets). Nothing
imports upwards."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "motiondiff_edu"

# The core is the syllabus: what the course teaches, by name. Not all of it is there yet.
CORE = {
    "ddpm", "prediction", "exact", "diffusion_dropout", "kinematic_loss", "cross_modal_attention",
    "inbetweening", "reconstruction", "rollout", "modiff", "mofusion", "training",
}  # fmt: skip
CORE_LINES, CORE_FILES = 1800, 12
LAYER = {"core": 0, "rest": 1, "viz": 2, "widgets": 3}
# the front door and the commands may reach everywhere, from within functions
COMMANDS = {"__init__", "__main__", "doctor"}

FILES = sorted(path for path in PACKAGE.rglob("*.py"))
ALL = FILES + sorted((ROOT / "data_synth").rglob("*.py"))


def layer(module: str) -> str:
    """core, rest, viz or widgets, of a dotted name below motiondiff_edu."""
    first = module.split(".")[0]
    return "core" if module in CORE else first if first in LAYER else "rest"


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")


def imports(path: Path) -> set[str]:
    """Absolute dotted names of all that a file imports, also within functions."""
    base = path.relative_to(ROOT).with_suffix("").parts
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = ".".join(base[: len(base) - node.level]) if node.level else ""
            source = ".".join(part for part in (above, node.module) if part)
            found |= {f"{source}.{alias.name}" for alias in node.names}
    return found


def third_party(path: Path) -> set[str]:
    """The packages outside of Python and this project that a file imports."""
    firsts = {name.split(".")[0] for name in imports(path)}
    return firsts - set(sys.stdlib_module_names) - {"motiondiff_edu", "data_synth"}


def own(path: Path) -> set[str]:
    """The modules of motiondiff_edu that a file imports, dotted below the package, names resolved
    to their file."""
    names = {
        name.removeprefix("motiondiff_edu.")
        for name in imports(path)
        if name.startswith("motiondiff_edu.")
    }
    modules = {module_of(file) for file in FILES}
    return {name if name in modules else name.rpartition(".")[0] for name in names} - {""}


def by_layer(*names: str) -> list[Path]:
    return [
        path
        for path in FILES
        if layer(module_of(path)) in names
        and module_of(path) not in COMMANDS
        and not module_of(path).startswith("_commands")
    ]


def named(paths: list[Path]):
    return [pytest.param(path, id=path.relative_to(ROOT).as_posix()) for path in paths]


@pytest.mark.parametrize("path", named(by_layer("core")))
def test_the_core_imports_torch_and_jaxtyping_only(path):
    allowed = {"torch", "jaxtyping"} | ({"tqdm"} if path.stem == "training" else set())
    assert third_party(path) <= allowed


def test_the_core_is_short():
    core = by_layer("core")
    lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in core)
    assert core and len(core) <= CORE_FILES and lines <= CORE_LINES, (
        f"{len(core)} files, {lines} lines"
    )


@pytest.mark.parametrize("path", named(by_layer(*LAYER)))
def test_nothing_imports_upwards(path):
    mine = LAYER[layer(module_of(path))]
    assert not {name for name in own(path) if LAYER[layer(name)] > mine}


@pytest.mark.parametrize(
    "package, allowed",
    [
        ("librosa", lambda name: name == "conditions.music"),
        ("ipywidgets", lambda name: name.startswith("widgets.")),
        ("anywidget", lambda name: name.startswith("widgets.")),
        ("matplotlib", lambda name: name.startswith(("viz.", "widgets."))),
    ],
)
def test_a_package_of_one_layer_stays_there(package, allowed):
    importers = [module_of(path) for path in FILES if package in third_party(path)]
    assert [name for name in importers if not allowed(name)] == []


def test_the_data_need_no_pictures_and_no_network():
    for path in ALL:
        if path.is_relative_to(ROOT / "data_synth"):
            assert not third_party(path) & {"matplotlib", "ipywidgets", "anywidget", "librosa"}, (
                path.name
            )
            assert not {name for name in own(path) if name.startswith(("viz", "widgets"))}, (
                path.name
            )


def test_every_third_party_import_is_declared():
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = [line for lines in project["optional-dependencies"].values() for line in lines]
    names = {
        line.split(">")[0].split("=")[0].replace("-", "_").lower()
        for line in project["dependencies"] + extras
    }
    names |= {"PIL"}  # pillow
    names |= {
        "jupyter_client",
        "IPython",
        "traitlets",
    }  # without these there is no JupyterLab and no ipywidgets
    used = set().union(*(third_party(path) for path in ALL))
    assert used <= names, f"imported, and not in pyproject.toml: {used - names}"


def test_no_file_puts_annotations_off():
    """`from __future__ import annotations` would turn the shapes into strings that nothing
    checks."""
    assert [path.name for path in ALL if "__future__.annotations" in imports(path)] == []
