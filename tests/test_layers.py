"""Who imports whom: each folder of the package is a layer, and nothing imports upwards."""

import ast
import re
import sys
import tomllib
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE, DATA = ROOT / "motiondiff_edu", ROOT / "data_synth"

# What stands left of a layer is what it may import; layers with a comma between them know nothing
# of each other. The syllabus is every .py at the top of the package.
CHAINS = (
    "_files syllabus motion beyond,conditions,metrics performers editing baselines pretrained"
    " recipes",
    "editing viz widgets course",
    "pretrained course",  # doctor and demo ask which weights there are
)
# the front door and the command line reach everywhere
FRONT = {"__init__", "__main__", "_commands"}
# The data need conventions, measures and Gaussian mixtures, and no network.
DATA_IMPORTS = {"_files", "motion", "metrics", "exact"}
DATA_READERS = {"recipes", "course"}

FILES = sorted(PACKAGE.rglob("*.py"))
ALL = FILES + sorted(DATA.rglob("*.py"))


def allowed() -> dict[str, set[str]]:
    """Of each layer the layers it may import, itself included."""
    below = {}
    for chain in CHAINS:
        so_far = set()
        for place in chain.split():
            for name in place.split(","):
                below[name] = below.get(name, set()) | so_far | {name}
            so_far = so_far.union(*(below[name] for name in place.split(",")))
    return below


def dotted(path: Path) -> str:
    """A file's module name, with `__init__` dropped."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


MODULES = {dotted(path): path for path in ALL}


def layer(module: str) -> str:
    """The layer of a module of motiondiff_edu: its folder, "syllabus", "_files" or "front"."""
    path = MODULES[module].relative_to(PACKAGE)
    if len(path.parts) > 1:
        return "front" if path.parts[0] in FRONT else path.parts[0]
    return "front" if path.stem in FRONT else "_files" if path.stem == "_files" else "syllabus"


@cache
def imports(path: Path) -> frozenset[str]:
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
    return frozenset(found)


def third_party(path: Path) -> set[str]:
    """The packages outside of Python and this project that a file imports."""
    firsts = {name.split(".")[0] for name in imports(path)}
    return firsts - set(sys.stdlib_module_names) - {"motiondiff_edu", "data_synth"}


def own(path: Path) -> set[str]:
    """The modules of this project that a file imports; what is no module is a name in one."""
    names = {n for n in imports(path) if n.split(".")[0] in ("motiondiff_edu", "data_synth")}
    return {name if name in MODULES else name.rpartition(".")[0] for name in names}


def upwards(path: Path) -> list[str]:
    """What a file of the package imports against the order of the layers."""
    mine = layer(dotted(path))
    if mine == "front":
        return []
    wrong = []
    for name in sorted(own(path)):
        if name.startswith("data_synth"):
            fits = mine in DATA_READERS
        else:
            fits = layer(name) in allowed()[mine]
        wrong += [] if fits else [name]
    return wrong


def named(paths: list[Path]):
    return [pytest.param(path, id=path.relative_to(ROOT).as_posix()) for path in paths]


def test_the_order_of_the_layers_is_what_the_chains_say():
    may = allowed()
    assert may["syllabus"] == {"_files", "syllabus"} and may["beyond"] == may["motion"] | {"beyond"}
    assert {"beyond", "metrics"} < may["performers"] and "baselines" not in may["performers"]
    assert "editing" in may["viz"] and not {"baselines", "pretrained"} & may["widgets"]
    assert "pretrained" in may["course"] and "recipes" not in may["course"]


def test_every_folder_is_a_layer():
    assert {layer(module) for module in map(dotted, FILES)} == {*allowed(), "front"}


def test_nothing_imports_upwards():
    assert {dotted(path): wrong for path in FILES if (wrong := upwards(path))} == {}


def test_an_import_within_a_function_is_seen(tmp_path, monkeypatch):
    low = tmp_path / "motiondiff_edu" / "motion" / "low.py"
    low.parent.mkdir(parents=True)
    low.write_text("def f():\n    from ..performers.walker import Walker\n    return Walker\n")
    monkeypatch.setattr(f"{__name__}.ROOT", tmp_path)
    monkeypatch.setattr(f"{__name__}.PACKAGE", tmp_path / "motiondiff_edu")
    walker = tmp_path / "motiondiff_edu" / "performers" / "walker.py"
    known = {"motiondiff_edu.motion.low": low, "motiondiff_edu.performers.walker": walker}
    monkeypatch.setattr(f"{__name__}.MODULES", known)
    assert upwards(low) == ["motiondiff_edu.performers.walker"]


SYLLABUS = [path for path in FILES if layer(dotted(path)) == "syllabus"]


@pytest.mark.parametrize("path", named(SYLLABUS))
def test_the_syllabus_imports_torch_and_jaxtyping_only(path):
    progress = {"tqdm"} if path.stem == "training" else set()
    assert third_party(path) <= {"torch", "jaxtyping"} | progress


def test_the_data_know_no_network():
    wrong = {}
    for path in DATA.rglob("*.py"):
        used = {n.split(".")[1] for n in own(path) if n.startswith("motiondiff_edu.")}
        shown = third_party(path) & {"matplotlib", "ipywidgets", "anywidget", "librosa"}
        if more := used - DATA_IMPORTS | shown:
            wrong[dotted(path)] = more
    assert wrong == {}


def test_nothing_imports_in_a_circle():
    graph = {dotted(path): own(path) - {dotted(path)} for path in ALL}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


@pytest.mark.parametrize(
    "package, places",
    [
        ("librosa", ("motiondiff_edu.conditions.compiled",)),
        ("transformers", ("motiondiff_edu.conditions.clip",)),
        ("huggingface_hub", ("motiondiff_edu.conditions.clip",)),
        ("ipywidgets", ("motiondiff_edu.widgets.",)),
        ("anywidget", ("motiondiff_edu.widgets.",)),
        ("matplotlib", ("motiondiff_edu.viz.", "motiondiff_edu.widgets.")),
    ],
)
def test_a_package_of_one_layer_stays_there(package, places):
    importers = [dotted(path) for path in FILES if package in third_party(path)]
    assert importers and [name for name in importers if not name.startswith(places)] == []


# imported inside functions, and the extra that has it
OPTIONAL = {"transformers": "clip", "huggingface_hub": "clip"}
RENAMED = {
    "pillow": "PIL",
    "scikit-learn": "sklearn",
    "ipython": "IPython",
    "fonttools": "fontTools",
}


def declared(lines: list[str]) -> set[str]:
    """What is imported under the requirements of these lines."""
    names = [re.split(r"[><=\[]", line)[0] for line in lines]
    return {RENAMED.get(name, name.replace("-", "_")) for name in names}


def project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_what_the_package_imports_is_a_dependency():
    """Of the package itself: an extra is not there after a plain install."""
    used = set().union(*(third_party(path) for path in ALL)) - set(OPTIONAL)
    missing = used - declared(project()["dependencies"])
    assert not missing, f"imported, and no dependency in pyproject.toml: {missing}"


@pytest.mark.parametrize("package, extra", OPTIONAL.items())
def test_a_package_of_an_extra_is_imported_inside_functions_alone(package, extra):
    assert package in declared(project()["optional-dependencies"][extra])
    for path in ALL:
        names = set()
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            names |= {alias.name for alias in getattr(node, "names", ())}
            names |= {getattr(node, "module", None) or ""}
        assert package not in {name.split(".")[0] for name in names}, path.name


ALONE = {"smalldiffusion", "denoising_diffusion_pytorch"}  # `make bench` installs them by itself


@pytest.mark.parametrize(
    "folder, extras", [("benchmarks", ["bench"]), ("tools", ["test", "bench"])]
)
def test_what_tools_and_benchmarks_import_is_in_their_extras(folder, extras):
    there = declared(project()["dependencies"]) | ALONE | {folder, "benchmarks", "tools"}
    for extra in extras:
        there |= declared(project()["optional-dependencies"][extra])
    shared = (ROOT / "tests" / "helpers").glob("*.py")  # of the tests; tools draw pages with them
    own_files = {path.stem for path in [*(ROOT / folder).rglob("*.py"), *shared]}
    used = set().union(*(third_party(path) for path in (ROOT / folder).rglob("*.py")))
    assert not used - there - own_files, f"in no extra of {folder}: {used - there - own_files}"


def test_no_file_puts_annotations_off():
    """No file turns its shapes into strings that nothing checks.

    `from __future__ import annotations` would.
    """
    assert [path.name for path in ALL if "__future__.annotations" in imports(path)] == []
