"""The files themselves: read in one sitting, tied to no machine, one statement a line."""

import ast
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import notebook_cells
import pytest

from motiondiff_edu import _files
from motiondiff_edu._files import check_writable, replacing

ROOT = Path(__file__).parent.parent

LIBRARY = sorted(
    path for folder in ("motiondiff_edu", "data_synth") for path in (ROOT / folder).rglob("*.py")
)
CODE = ("motiondiff_edu", "data_synth", "tools", "benchmarks", "tests")
SOURCES = [
    *sorted(path for folder in CODE for path in (ROOT / folder).rglob("*.py")),
    *notebook_cells.sources(),
]
TEXT = {
    ".py",
    ".md",
    ".toml",
    ".yml",
    ".yaml",
    ".ipynb",
    ".js",
    ".json",
    ".txt",
    ".cff",
    ".cfg",
    ".in",
    "",
}

FORBIDDEN = {
    "an absolute path of one machine": r"(?<![\w.~:/])/(home|root|Users|tmp|mnt|opt|srv|work)/\w",
    "a package registry": (
        r"\b(pypi|pythonhosted|conda\.anaconda|npmjs|unpkg|jsdelivr|crates)\.(org|com|io|net)\b"
    ),
    "a loose end": r"\bTO[D]O\b|\bFIX[M]E\b|\bX[X]X\b",
}
THIS = Path(__file__)


def tracked() -> list[Path]:
    """The text files of the project: those that git tracks, or in an unpacked archive all."""
    answer = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    names = answer.stdout.splitlines() if answer.returncode == 0 else []
    paths = [ROOT / name for name in names] or [
        path for path in ROOT.rglob("*") if ".venv" not in path.parts
    ]
    return [path for path in paths if path.is_file() and path.suffix in TEXT]


def packed(source: str) -> list[str]:
    """Assignments that pack three values or more into as many targets."""
    return [
        f"line {node.lineno}: {ast.unparse(node.targets[0])}"
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Tuple | ast.List)
        and isinstance(node.value, ast.Tuple | ast.List)
        and len(node.targets[0].elts) > 2
    ]


def test_packed_assignments_are_found():
    assert packed("a, b, c = 1, 2, 3") == ["line 1: (a, b, c)"]
    assert packed("if x:\n    [a, b, *c] = [1, *more]") == ["line 2: [a, b, *c]"]
    assert packed("a, b = b, a\na, b, c = three()\nfor a, b, c in rows: pass") == []


def test_one_assignment_a_line():
    """At most two values are assigned at once, as in a swap; more go on lines of their own."""
    assert [
        f"{path.relative_to(ROOT)}: {line}"
        for path in SOURCES
        for cell in notebook_cells.python_of(path)
        for line in packed(cell)
    ] == []


@pytest.mark.parametrize("what", FORBIDDEN)
def test_nothing_is_tied_to_one_machine_or_left_loose(what):
    pattern, found = re.compile(FORBIDDEN[what]), []
    for path in tracked():
        if path == THIS:
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if pattern.search(line):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}")
    assert found == [], f"{what}:\n" + "\n".join(found)


def test_shipped_weights_stay_small():
    sizes = {
        path.name: path.stat().st_size
        for path in (ROOT / "motiondiff_edu/pretrained").glob("*.safetensors")
    }
    assert sum(sizes.values()) <= 36e6 and max(sizes.values()) <= 6e6, sizes


def test_every_weights_file_has_its_card():
    folder = ROOT / "motiondiff_edu" / "pretrained"
    assert [
        path.name
        for path in folder.glob("*.safetensors")
        if not path.with_suffix(".json").is_file()
    ] == []


def test_no_pickle():
    """Weights and data come without code in them.

    AIST++'s pickles are read by an unpickler that knows only arrays.
    """
    pattern = re.compile(r"import pickle|pickle\.|\btorch\.(save|load)\(|allow_pickle\s*=\s*True")
    found = [path.name for path in LIBRARY if pattern.search(path.read_text(encoding="utf-8"))]
    assert sorted(found) == ["aist.py", "humanml3d.py"]
    (told,) = (path.read_text(encoding="utf-8") for path in LIBRARY if path.name == "humanml3d.py")
    assert len(pattern.findall(told)) == 1 and "numpy.load({name!r}, allow_pickle=True)" in told
    (reader,) = (path.read_text(encoding="utf-8") for path in LIBRARY if path.name == "aist.py")
    assert (
        not re.search(r"pickle\.loads?\(|allow_pickle\s*=\s*True", reader)
        and "find_class" in reader
    )


def test_threads_that_write_one_file_do_not_tear_it(tmp_path):
    """Each text is long enough to be written in pieces; what is read is always one of them."""
    path, read = tmp_path / "one.txt", []
    texts = [letter * 200_000 for letter in "abcd"]

    def write(text: str) -> None:
        for _ in range(20):
            with replacing(path) as aside, aside.open("w") as file:
                for start in range(0, len(text), 20_000):
                    file.write(text[start : start + 20_000])
                    file.flush()
            read.append(path.read_text())

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(write, texts))
    assert set(read) <= set(texts) and len(read) == 80
    assert [p.name for p in tmp_path.iterdir()] == ["one.txt"]


def test_a_message_names_the_file_that_was_asked_for(tmp_path):
    path = tmp_path / "walk.npz"
    with pytest.raises(OSError, match=r"no room: '.*/walk\.npz'$"), replacing(path) as aside:
        raise OSError(28, "no room", str(aside))
    with pytest.raises(OSError, match="no room: 'another'"), replacing(path):
        raise OSError(28, "no room", "another")


@pytest.mark.skipif(os.name == "nt", reason="there no process is asked whether it runs")
def test_what_a_killed_write_left_is_removed_by_the_next(tmp_path):
    """Not what a running process writes, or what belongs to another file or another machine."""
    script = (
        "import sys, time\nfrom motiondiff_edu._files import check_writable, replacing\n"
        "with replacing(sys.argv[1]) as aside:\n"
        "    aside.write_text('half'); print(aside.name, flush=True); time.sleep(600)\n"
    )
    path, other = tmp_path / "a [walk].bvh", tmp_path / "b [walk].bvh"
    command = [sys.executable, "-c", script]
    writers = [
        subprocess.Popen([*command, str(one)], stdout=subprocess.PIPE, text=True)
        for one in (path, path, other)
    ]
    try:
        killed, running, of_another = (writer.stdout.readline().strip() for writer in writers)
        for writer in (writers[0], writers[2]):
            writer.kill()
            writer.wait()
        elsewhere = killed.replace(f".{_files._machine()}.", ".zzzz.")
        (tmp_path / elsewhere).write_text("of another machine")
        left = {killed, running, of_another, elsewhere}
        assert {one.name for one in tmp_path.iterdir()} == left
        with replacing(path) as aside:
            aside.write_text("whole")
        left = {running, of_another, elsewhere, path.name}
        assert {one.name for one in tmp_path.iterdir()} == left
    finally:
        for writer in writers:
            writer.kill()
            writer.wait()


def test_a_place_is_tried_and_left_as_it_was(tmp_path):
    check_writable(tmp_path / "new" / "folder" / "walk.bvh")
    assert not any(tmp_path.iterdir())
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match="file is a file, not a folder; choose another place"):
        check_writable(tmp_path / "file" / "walk.bvh")
    with pytest.raises(OSError, match="is a folder; give the name of a file in it"):
        check_writable(tmp_path)
    with pytest.raises(OSError, match="name too long.; choose another place"):
        check_writable(tmp_path / ("x" * 300 + ".bvh"))


@pytest.mark.parametrize(
    "path", sorted((ROOT / "motiondiff_edu/widgets/js").glob("*.js")), ids=lambda path: path.name
)
def test_javascript_has_100_columns_and_one_declaration_a_line(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    assert [n for n, line in enumerate(lines, 1) if len(line) > 100] == []
    assert [n for n, line in enumerate(lines, 1) if re.search(r";\s*(const|let)\s", line)] == []
