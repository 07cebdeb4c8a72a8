"""`motiondiff-edu collect`: a class of students with all kinds of answers."""

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import notebook_cells
import pytest

from motiondiff_edu.__main__ import main
from motiondiff_edu.course import answers, collect, fence, trial

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="collect needs fork")
NAME = "02_noise.ipynb"
RIGHT = """def my_constant_beta(S, left):
    return 1 - left ** (2 / S)


checks.constant_beta(my_constant_beta)"""
WRONG = RIGHT.replace("2 / S", "1 / S")
LOOP = RIGHT.replace(
    "return 1", "import time\n    while True:\n        time.sleep(9)\n    return 1"
)
HOG = RIGHT.replace("return 1", "x = bytearray(3 * 2**29)\n    return 1")  # 1.5 GB
CRASH = RIGHT.replace("return 1", "import os\n    os._exit(3)\n    return 1")
LEAVE = RIGHT.replace("return 1", "raise SystemExit\n    return 1")
LONG = RIGHT.replace("return 1", "raise ValueError('\\udcff' + 'x' * 70_000)\n    return 1")
SHOUT = RIGHT.replace("return 1", "import os; os.system('echo done; echo dead >&2')\n    return 1")
LINGER = RIGHT.replace(
    "return 1", "import os, time\n    if not os.fork():\n        time.sleep(15)\n    return 1"
)
LEFT_BEHIND = "import subprocess; subprocess.Popen(['sleep', '317.5'])"
LEAVES = RIGHT.replace("return 1", f"{LEFT_BEHIND}\n    return 1")
BROKEN = "def my_constant_beta(S, left:\n    return 1\nchecks.constant_beta(my_constant_beta)"
CALL = "checks.constant_beta(my_constant_beta)"
STUB = """def my_constant_beta(S, left):
    \"\"\"The beta that, used S times, leaves this share of the amplitude.\"\"\"
    raise NotImplementedError("your turn")


checks.constant_beta(my_constant_beta)"""
HELPER = RIGHT.replace("left ** (2 / S)", "power(left, TWO / S)")
TIDY = "import os\nassert not os.listdir()\nopen('left', 'w').close()\n"
RIGHT_WAYS = {
    "called_again": [RIGHT, CALL],
    "own_cell": [STUB, RIGHT.replace(CALL, ""), CALL],
    "imported": ["from math import pow as power\nTWO = 2\nprint(undefined)", HELPER],
    "function": ["TWO = 2\ndef power(a, b):\n    return a ** b", HELPER],
    "timed": ["%%time\n" + RIGHT],
    "shell": ["!ls\n" + RIGHT],
    "noted": [RIGHT, f"# {CALL} passes now\nx = 1"],
    # what an answer leaves in its folder, the next one does not see
    "leaves_a_file": [TIDY + RIGHT],
    "sees_no_file": [TIDY + RIGHT],
    "sums": [
        "import math\nHALF = 1 / 2\nHALF *= 2\nTWO: float = -(-2.0) * HALF",
        HELPER.replace("power(", "math.pow("),
    ],
    "computed": ["import numpy as np\nTWO = float(np.sqrt(4))\npower = pow", HELPER],
    "tried": [
        "try:\n    import math\nexcept ImportError:\n    pass\nTWO = 2",
        HELPER.replace("power(", "math.pow("),
    ],
    "lambda": ["my_constant_beta = lambda S, left: 1 - left ** (2 / S)", CALL],
}
# those whose exercise is open
OPEN_WAYS = {"stub_again": [STUB, CALL], "stub_last": [RIGHT, STUB]}
FOREIGN = os.fsdecode(b"Ren\xe9")  # a folder's name that is no UTF-8


def with_cells(folder, who, *sources, name=NAME, changed=None):
    """Hand in notebook 02 with the cell of exercise 3 replaced by these cells."""
    notebook = json.loads((notebook_cells.NOTEBOOKS / "student" / NAME).read_text())
    at = next(
        i
        for i, cell in enumerate(notebook["cells"])
        if cell["cell_type"] == "code" and "checks.constant_beta(" in "".join(cell["source"])
    )
    mine = [{"cell_type": "code", "source": source, "metadata": {}} for source in sources]
    notebook["cells"][at : at + 1] = mine
    (folder / who).mkdir(exist_ok=True)
    (folder / who / name).write_text(json.dumps(notebook))
    if changed:
        os.utime(folder / who / name, (changed, changed))


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory):
    """A folder of copies; each student changed the cell of exercise 3 of notebook 02."""
    folder = tmp_path_factory.mktemp("handed_in")
    own = notebook_cells.NOTEBOOKS / "student" / NAME
    changes = {
        "ada": RIGHT, "bo": WRONG, "cy": WRONG, "di": LOOP, "ed": HOG, "fu": CRASH, "gil": LEAVE,
        "ha": BROKEN, "io": None, "mo": LONG, "nic": SHOUT, "oz": LINGER,
        "pia": LEAVES,
    }  # fmt: skip
    for who, source in changes.items():
        notebook = json.loads(own.read_text())
        for cell in notebook["cells"]:
            if source and "checks.constant_beta(" in "".join(cell["source"]):
                if cell["cell_type"] == "code":
                    cell["source"] = source.splitlines(keepends=True)
        (folder / who / "deeper").mkdir(parents=True)
        (folder / who / "deeper" / NAME).write_text(json.dumps(notebook))
    (folder / "jo").mkdir()
    (folder / "jo" / NAME).write_text("{not json")
    (folder / "lou").mkdir()
    shutil.copy(notebook_cells.NOTEBOOKS / NAME, folder / "lou" / NAME)
    (folder / "kit").mkdir()
    (folder / "kit" / NAME).write_text(json.dumps({"cells": []}))
    for who, sources in (RIGHT_WAYS | OPEN_WAYS).items():
        with_cells(folder, who, *sources)
    for who, last in {"fresh": STUB, "again": WRONG}.items():  # `lab --fresh` kept the old copy
        with_cells(folder, who, RIGHT, name="02_noise_mine.ipynb", changed=1)
        with_cells(folder, who, last)
    if sys.platform == "linux":
        with_cells(folder, FOREIGN, RIGHT)
    return folder


@pytest.fixture(scope="module")
def collected(handed_in, tmp_path_factory):
    """What it prints, the rows of its file, and what it says beside."""
    out = tmp_path_factory.mktemp("out") / "class.csv"
    command = ["collect", str(handed_in), "--out", str(out), "--seconds", "3", "--gigabytes", "1"]
    done = subprocess.run(
        [sys.executable, "-m", "motiondiff_edu", *command], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    with out.open(encoding="utf-8-sig") as file:
        return done.stdout, list(csv.DictReader(file)), done.stderr


def of(rows, who, exercise="constant_beta"):
    row = next(row for row in rows if (row["student"], row["exercise"]) == (who, exercise))
    return row["result"], row["message"]


def test_each_answer_gets_its_result(collected):
    _, rows, _ = collected
    assert of(rows, "ada") == ("right", "")
    assert of(rows, "bo")[0] == "wrong" and "amplitude" in of(rows, "bo")[1]
    assert of(rows, "di") == ("too slow", "stopped after 3 s")
    if sys.platform == "linux":
        assert of(rows, "ed")[0] in ("wrong", "died") and "memory" in of(rows, "ed")[1].lower()
    assert of(rows, "fu") == ("died", "the process ended by itself, with status 3")
    assert of(rows, "gil")[0] == "failed" and "SystemExit" in of(rows, "gil")[1]
    assert of(rows, "ha")[0] == "failed" and "SyntaxError" in of(rows, "ha")[1]
    assert of(rows, "io") == ("not attempted", "")
    assert of(rows, "jo")[0] == "unreadable" and NAME in of(rows, "jo")[1]
    result, message = of(rows, "mo")
    assert result == "wrong" and "ValueError" in message and "?xxx" in message
    assert len(message) < 600
    for who in ("nic", "oz", "pia"):
        assert of(rows, who) == ("right", "")
    assert of(rows, "kit") == ("not attempted", "its cell is gone")


def test_one_bad_answer_does_not_touch_the_others(collected):
    _, rows, _ = collected
    for who in ("ada", "di", "ed", "fu", "io", "mo", "nic"):
        assert of(rows, who, "q_sample") == ("not attempted", "")
    assert len(rows) == 3 * len({row["student"] for row in rows}) > 3 * 25


def test_the_table_and_the_commonest_mistakes(collected):
    said, _, _ = collected
    lines = {line.split()[0]: line for line in said.splitlines() if line[:1].isalpha()}
    assert lines["ada"].split()[1:] == ["..+", "1", "of", "3"]
    assert lines["bo"].split()[1] == "..x" and lines["jo"].split()[1] == "xxx"
    first = said.split("Mistakes that several people made:\n")[1].splitlines()[0]
    assert first.startswith("  3 x  02 constant_beta: beta: that leaves the share")


def test_a_copy_with_its_solution_is_right_everywhere(collected):
    said, rows, _ = collected
    lines = {line.split()[0]: line for line in said.splitlines() if line[:1].isalpha()}
    assert lines["lou"].split()[1:] == ["+++", "3", "of", "3"]
    assert of(rows, "lou", "posterior") == ("right", "")


def test_what_an_answer_started_ends_with_it(collected):
    running = [path.read_bytes() for path in Path("/proc").glob("[0-9]*/cmdline") if path.exists()]
    assert not [command for command in running if b"317.5" in command]


def test_what_an_answer_prints_by_other_ways_stays_away(collected):
    said, _, beside = collected
    assert "done" not in said.split() and "dead" not in beside.split()


@pytest.mark.parametrize("who", RIGHT_WAYS)
def test_right_answers_are_right_however_they_are_written(collected, who):
    assert of(collected[1], who) == ("right", "")


@pytest.mark.parametrize("who", OPEN_WAYS)
def test_the_last_cell_that_calls_a_check_counts(collected, who):
    assert of(collected[1], who) == ("not attempted", "")


def test_a_fresh_copy_does_not_hide_the_old_answers(collected):
    """Unless the exercise was tried again."""
    assert of(collected[1], "fresh")[0] == "right"
    assert of(collected[1], "again")[0] == "wrong"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems refuse such names")
def test_a_folder_whose_name_is_no_utf8(collected):
    said, rows, _ = collected
    assert of(rows, "Ren\\udce9")[0] == "right" and "Ren\\udce9" in said


def test_the_last_copy_of_a_student_is_the_first(tmp_path):
    copies = {}
    for name in ("old", "new", ".ipynb_checkpoints"):
        copies[name] = tmp_path / "x" / name / NAME
        copies[name].parent.mkdir(parents=True)
        copies[name].write_text("{}")
    os.utime(copies["old"], (1, 1))
    found = collect.copies_of(tmp_path, [])
    assert found == {("x", "02"): [copies["new"], copies["old"]]}
    assert collect.copies_of(tmp_path, ["2"]) == found


@pytest.mark.parametrize(
    "arguments, told",
    [
        (["nowhere"], "nowhere is no folder; it should have a folder for each student"),
        (["."], "has no copies of the notebooks; expected for instance"),
    ],
)
def test_what_cannot_be_collected_is_told(arguments, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["collect", *arguments]) == 1
    assert told in capsys.readouterr().err


def test_a_notebook_that_the_course_does_not_have_is_left_out(tmp_path, capsys):
    (tmp_path / "x").mkdir()
    (tmp_path / "x" / "99_notes.ipynb").write_text("{}")
    assert main(["collect", str(tmp_path)]) == 1
    told = capsys.readouterr().err
    assert "notebook 99: 1 copy left out, the course has no such notebook" in told
    assert "the course has no exercises for these copies" in told


@pytest.mark.parametrize(
    "source, kept",
    [
        ("TWO = 2\nTWO = train(TWO)", {}),  # no value of before
        ("TWO = []\nTWO.append(2)", {}),
        ("TWO = 2\nfor TWO in range(9):\n    pass", {}),
        ("TWO = 1\nTWO += 1", {"TWO": 2}),
        ("import math\nmath.sqrt(2)\nTWO = math.sqrt(4)", {"TWO": 2.0}),
        ("TWO = len([1, 2])\nTWO.bit_length()", {"TWO": 2}),
        ("TWO = []\nfor k in (1, 2):\n    TWO.append(k)", {}),
        ("TWO = [1]\nTWO[0] = compute()", {}),
        ("TWO = 1\ndel TWO", {}),
        ("TWO = 1\nTWO = max(NOT_THERE)", {}),
        ("TWO = 2\nrows = [TWO for TWO in range(3)]\nshow(TWO)", {"TWO": 2}),
        ("TWO = list(range(3))", {"TWO": [0, 1, 2]}),
    ],
)
def test_names_have_their_last_value_or_none(source, kept):
    names = trial._defined(answers.definitions(source), {})
    assert {key: names[key] for key in ("TWO",) if key in names} == kept


@pytest.mark.parametrize(
    "name, number",
    [
        ("02_noise.ipynb", "02"), ("02_noise-Copy1.ipynb", "02"), ("Copy of 02_noise.ipynb", "02"),
        ("anna_02-noise.IPYNB", "02"), ("02.ipynb", "02"), ("02 mine.ipynb", "02"),
        ("99_notes.ipynb", "99"), ("homework week 2.ipynb", ""), ("2026-11-02 x.ipynb", ""),
        ("102_noise_of_mine.ipynb", "02"), ("noise.ipynb", ""), ("10_02_noise.ipynb", "02"),
        ("12.03.2026 02_noise.ipynb", "02"), ("12.03.2026.ipynb", ""),
    ],
)  # fmt: skip
def test_a_renamed_notebook_is_known_by_its_name(name, number):
    assert collect.number_of(name) == number


def test_what_is_left_out_is_named_and_a_table_is_kept(tmp_path, capsys):
    (tmp_path / "x" / "a").mkdir(parents=True)
    (tmp_path / "x" / "b").mkdir()
    for name in ("x/week two.ipynb", "02_noise.ipynb", "x/a/99_x.ipynb", "x/b/99_x.ipynb"):
        (tmp_path / name).write_text("{}")
    assert main(["collect", str(tmp_path)]) == 1
    told = capsys.readouterr().err
    assert "the notebooks of the course: 02_noise.ipynb, x/week two.ipynb" in told
    assert f"Is {tmp_path} one folder too high?" in told
    table = tmp_path / "class.csv"
    table.write_text("my marks")
    assert main(["collect", str(tmp_path), "--out", str(table)]) == 1
    assert "or add --overwrite" in capsys.readouterr().err and table.read_text() == "my marks"


def test_without_a_fence_that_is_said(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(fence, "version", lambda: 0)
    assert main(["collect", str(tmp_path)]) == 1
    assert "an answer can change and remove all your files" in capsys.readouterr().err
    assert [len(fence.without(has)) for has in (0, 1, 3, 4, 6)] == [4, 3, 2, 1, 0]


FENCED = """
import os, socket, subprocess, sys
from pathlib import Path
from motiondiff_edu.course import fence
inside, outside, parent = Path("inside").absolute(), Path("outside").absolute(), os.getppid()
server = socket.create_server(("127.0.0.1", 0))
before = len(os.listdir("/proc/self/fd"))
assert fence.keep_within(inside) == bool(fence.version())
os.chdir(inside)
Path("mine").write_text("x"); os.mkdir("deep"); os.rename("mine", "deep/mine")
Path("/dev/null").write_text("x")
assert (outside / "file").read_text() == "theirs"
def refused(*steps):
    for step in steps:
        try: step()
        except OSError: continue
        sys.exit(f"{step.__code__.co_consts} was not refused")
refused(
    lambda: (outside / "new").write_text("x"), lambda: (outside / "file").write_text("x"),
    lambda: os.mkfifo(outside / "pipe"), lambda: os.remove(outside / "file"),
    lambda: socket.socket(socket.AF_UNIX).bind(str(outside / "socket")),
    lambda: os.rename(outside / "file", "file"), lambda: os.mkdir(outside / "folder"),
    lambda: os.symlink("file", outside / "link"), lambda: os.rmdir(outside / "empty"),
)
subprocess.run(["rm", "-rf", str(outside)], stderr=subprocess.DEVNULL)
if fence.version() >= 3: refused(lambda: os.truncate(outside / "file", 0))
if fence.version() >= 4:
    refused(lambda: socket.create_connection(server.getsockname(), 5))
    refused(lambda: socket.create_server(("127.0.0.1", 0)))
if fence.version() >= 6: refused(lambda: os.kill(parent, 0))
assert "NoNewPrivs:\\t1" in Path("/proc/self/status").read_text()
assert len(os.listdir("/proc/self/fd")) == before, "a descriptor is left"
"""


@pytest.mark.skipif(not fence.version(), reason="this system has no Landlock")
def test_what_a_fence_refuses(tmp_path):
    for name in ("inside", "outside/empty"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "outside" / "file").write_text("theirs")
    done = subprocess.run(
        [sys.executable, "-c", FENCED], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "outside").iterdir()) == ["empty", "file"]
    assert (tmp_path / "outside" / "file").read_text() == "theirs"


def test_a_version_of_landlock_gets_the_bits_that_it_knows():
    assert fence.rights_of(fence.FILES, 1) == 0b1_1111_1111_0010
    assert fence.rights_of(fence.FILES, 2) == 0b11_1111_1111_0010
    assert fence.rights_of(fence.FILES, 7) == 0b1111_1111_1111_0010
    assert [fence.rights_of(fence.TCP, has) for has in (3, 4)] == [0, 3]


def test_a_fence_that_fails_is_said(tmp_path, monkeypatch, capfd):
    def fails(folder):
        raise OSError(7, "Landlock: no")

    monkeypatch.setattr(fence, "keep_within", fails)
    question = {"folder": str(tmp_path), "gigabytes": 2, "seconds": 9, "token": "t", "check": "x"}
    assert trial.apart(question | {"paths": []}, {}, {}) == (answers.DIED, "[Errno 7] Landlock: no")


@pytest.mark.skipif(not fence.version(), reason="this system has no Landlock")
def test_an_answer_removes_nothing_outside_its_folder(tmp_path):
    (tmp_path / "keep").write_text("mine")
    handed_in = tmp_path / "handed_in"
    handed_in.mkdir()
    with_cells(handed_in, "x", f"import shutil\nshutil.rmtree({str(tmp_path)!r}, True)\n{RIGHT}")
    assert main(["collect", str(handed_in)]) == 0
    assert (tmp_path / "keep").read_text() == "mine" and list(handed_in.rglob("*.ipynb"))


def test_only_takes_numbers(tmp_path, capsys):
    (tmp_path / "x").mkdir()
    for wrong in ("noise", "nb02"):
        assert main(["collect", str(tmp_path), "--only", wrong]) == 1
        assert "--only takes numbers of notebooks" in capsys.readouterr().err


def test_a_student_without_a_copy_is_named(tmp_path, capsys):
    for who in ("ann", "bo\x1b"):
        (tmp_path / who).mkdir()
    (tmp_path / "ann" / NAME).write_text("{}")
    assert list(collect.copies_of(tmp_path, [])) == [("ann", "02")]
    assert capsys.readouterr().err == "no copies were found in the folders: bo\\x1b\n"


def test_two_folders_never_have_one_name():
    names = ["a\x1b", "a\\x1b", "a\\\\x1b", os.fsdecode(b"\xe9"), "\\udce9", "Zoë"]
    shown = [collect.name_of(name) for name in names]
    assert len(set(shown)) == len(names) and all(name.isprintable() for name in shown)


@pytest.mark.parametrize("line", [b"", b"{", b"[]", b"[1, 2, 3]", b'["t", ["right"], ""]'])
def test_what_is_no_result_of_the_question_is_not_read(line):
    assert answers.read_back(line, "t") is None
    assert answers.read_back(answers.written("other", "right", ""), "t") is None
    assert answers.read_back(answers.written("t", "great", ""), "t") is None
    assert answers.read_back(answers.written("t", "right", "x" * 9999), "t")


def test_answers_are_found_wherever_they_were_moved_to(tmp_path):
    source = "x = 1\nchecks.bag(my_bag)"
    notebook = {"cells": [{"cell_type": "code", "source": "checks.bag(old)"}]}
    notebook["cells"].append({"cell_type": "code", "source": source, "metadata": {}})
    path = tmp_path / "16.ipynb"
    path.write_text(json.dumps(notebook))
    assert answers.of_copy(path) == {"bag": answers.Answer(source)}
    assert answers.exercises(path) == ["bag"]
