"""The verbs on the command line: what they write and say, and that mistakes cost no work."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from argparse import Namespace
from contextlib import suppress
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import soundfile
import torch
from browser import PATIENCE

import motiondiff_edu as md
from data_synth.music import compose
from data_synth.walking import walk
from motiondiff_edu import __main__ as command
from motiondiff_edu import _commands, _files
from motiondiff_edu._commands import control_words, edit, outputs
from motiondiff_edu.course import doctor
from motiondiff_edu.editing.by_words import STRENGTH
from motiondiff_edu.motion.motion import MotionError
from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.performers.dancer import USUAL_GUIDANCE
from motiondiff_edu.pretrained import checkpoints

ARM = "RightArm,RightForeArm,RightHand"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with a walk and a song."""
    made = tmp_path_factory.mktemp("made")
    control = np.tile([1.0, 0.0, 0.2], (50, 1))
    md.Motion.of_clip(walk(control, seed=2)).save(made / "my_walk.bvh")
    soundfile.write(made / "song.wav", compose(3, "pop", seconds=5).audio, 16_000)
    return made


@pytest.fixture
def folder(made, tmp_path, monkeypatch, capsys):
    """A copy of it, entered."""
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    capsys.readouterr()
    return tmp_path


def run(*words: str) -> int:
    """The exit code of `motiondiff-edu words`."""
    try:
        return command.main(list(words))
    except SystemExit as stopped:
        return stopped.code


def test_a_walk_is_continued_from_the_command_line(folder, capsys):
    words = ["walk", "my_walk.bvh", "--control", "1s 1.2; 0.5s 1.0 turn 0.6"]
    assert run(*words, "--out", "more.npz") == 0
    said = capsys.readouterr()
    assert "more.npz: 1.5 s, 30 frames" in said.out and "reading my_walk.bvh" in said.err
    more = md.read_motion("more.npz")
    np.testing.assert_allclose(more.control[5], [1.2, 0, 0], atol=1e-9)
    # the turn sets in within half a second, by 3u^2 - 2u^3: at its end it is there
    np.testing.assert_allclose(more.control[28, 2], 0.6 * (3 * 0.9**2 - 2 * 0.9**3), atol=1e-9)
    assert run(*words, "--joined", "--out", "both.npz") == 0
    both = md.read_motion("both.npz")
    assert len(both) == 80
    np.testing.assert_array_equal(both.positions[50:], more.positions)


def test_a_song_is_danced_to_from_the_command_line(folder, capsys):
    assert run("dance", "song.wav", "--seconds", "1.5", "--out", "dance.bvh") == 0
    assert len(md.read_motion("dance.bvh")) == 30
    said = capsys.readouterr()
    assert "dance.bvh: 1.5 s, 30 frames" in said.out and "the dance ends" not in said.err


def test_a_song_shorter_than_asked_is_said(folder, capsys):
    assert run("dance", "song.wav", "--seconds", "60", "--out", "dance.bvh") == 0
    lasts = md.read_motion("dance.bvh").seconds
    told = capsys.readouterr().err
    assert f"note: song lasts {lasts:.1f} s, and the dance ends with it" in told


def test_info_describes_every_file_that_can_be_read(folder, capsys):
    (folder / "a.bvh").write_text("HIERARCHY")
    assert run("info", "a.bvh", "my_walk.bvh", "b.bvh") == 1
    told = capsys.readouterr()
    assert "Motion 'my_walk'" in told.out and "there is no file b.bvh" in told.err
    assert "info: 2 of 3 files cannot be read" in told.err


# every verb, as it works
VERBS = {
    "walk": ["my_walk.bvh", "--control", "1s 1"],
    "dance": ["song.wav"],
    "act": ["walks"],
    "inbetween": ["my_walk.bvh"],
    "reconstruct": ["my_walk.bvh", "--missing", "LeftHand"],
    "edit": ["my_walk.bvh", "walks while clapping"],
    "info": ["my_walk.bvh"],
    "convert": ["my_walk.bvh"],
    "play": ["my_walk.bvh", "--no-open"],
}
WRITING = sorted(VERBS.keys() - {"info"})


def writing(verb: str, out: str) -> list[str]:
    """A command that works, if it may write there."""
    return [verb, *VERBS[verb], *([] if verb == "convert" else ["--out"]), out]


def options_of(verb: str) -> list:
    (verbs,) = [
        action
        for action in command.parser_of(command.imported()[0])._actions
        if isinstance(action.choices, dict)
    ]
    return verbs.choices[verb]._actions


NUMBERS = [
    (verb, action.option_strings[0])
    for verb in VERBS
    for action in options_of(verb)
    if action.type in (int, float)
]


@pytest.fixture
def no_work(folder, monkeypatch):
    """The folder, where a motion that is read, or weights that are loaded, fail the test."""

    def work(*_, **__):
        pytest.fail("it works before everything is checked", pytrace=False)

    # md first: it keeps the function that it finds in checkpoints
    for module, name in ((md, "load"), (checkpoints, "load"), (outputs, "read")):
        monkeypatch.setattr(module, name, work)
    return folder


def refused(words: list[str], folder: Path, capsys) -> str:
    """The only line that a command says when it is refused; no file is written."""
    before = sorted(folder.rglob("*"))
    assert run(*words) == 1
    said = capsys.readouterr()
    (only,) = said.err.splitlines()
    assert only.startswith(f"{words[0]}: ") and not said.out
    assert sorted(folder.rglob("*")) == before
    return only


def test_every_verb_is_tried():
    assert list(VERBS) == list(_commands.VERBS)
    assert {("act", "--seconds"), ("convert", "--file-fps"), ("walk", "--seed")} <= set(NUMBERS)


@pytest.mark.parametrize("value", ["-3", "1e300"])
@pytest.mark.parametrize("verb, option", NUMBERS)
def test_a_number_out_of_range_is_refused_before_any_work(verb, option, value, no_work, capsys):
    (kind,) = [action.type for action in options_of(verb) if option in action.option_strings]
    value = "9" * 30 if (kind, value) == (int, "1e300") else value
    if option == "--every" and value != "-3":
        pytest.skip("a keyframe every so many frames is the first and the last one")
    ext = ".html" if verb == "play" else ".npz"
    told = refused([*writing(verb, f"x{ext}"), option, value], no_work, capsys)
    assert option.strip("-").split("-")[-1] in told


PLACES = {
    "no ending": ("out", "the name has no ending|must end in .html"),
    "an unknown ending": ("out.docx", "unknown ending .docx|must end in .html"),
    "a folder": ("folder.html", "folder.html is a folder"),
    "a file as folder": ("my_walk.bvh/out.html", "my_walk.bvh is a file, not a folder"),
    "a name too long": ("x" * 300 + ".html", "name too long"),
    "there already": ("there.html", "exists already: choose another name, or add --overwrite"),
    "a folder that takes no file": ("/proc/new/out.html", "no file can be made in /proc"),
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("verb", WRITING)
def test_a_place_that_cannot_be_written_is_refused_before_any_work(verb, place, no_work, capsys):
    out, told = PLACES[place]
    if out.startswith("/proc") and not Path("/proc").is_dir():
        pytest.skip("this system has no such folder")
    (no_work / "folder.html").mkdir()
    (no_work / "there.html").touch()
    assert re.search(told, refused(writing(verb, out), no_work, capsys), re.I)


@pytest.mark.parametrize(
    "words, told",
    [
        (["dance", "nope.ogg", "--out", "x.bvh"], "there is no file nope.ogg"),
        (["play", "my_walk.bvh", "nope.bvh"], "there is no file nope.bvh"),
        (["act", "walks", "--seconds", "1", "--out", "x.bvh"], "seconds must be from 2 to 10"),
        (["walk", "my_walk.bvh", "--control", "1s", "--out", "x.bvh"], "speed .* is missing"),
        ([*writing("edit", "x.bvh"), "--keep", "tail"], "no part is called 'tail'"),
        (["reconstruct", "my_walk.bvh", "--missing", "Tail", "--out", "x.bvh"], "called 'Tail'"),
        ([*writing("reconstruct", "x.bvh"), "--frames", "9-3"], "9 comes after 3"),
        ([*writing("convert", "x.bvh"), "--joints", "LeftArm"], "write JOINT=NAME"),
        ([*writing("inbetween", "x.bvh"), "--at", "4,x"], "--at 4,x: 'x' is not a span"),
    ],
)
def test_other_arguments_are_checked_before_any_work(words, told, no_work, capsys):
    assert run(*words) == 1
    assert re.search(told, capsys.readouterr().err)


def test_missing_joints_are_separated_by_commas_or_spaces(folder):
    for names in (["LeftHand,LeftForeArm"], ["LeftHand,", "LeftForeArm"], ["LeftHand LeftForeArm"]):
        words = ["reconstruct", "my_walk.bvh", "--missing", *names, "--frames", "20-24"]
        assert run(*words, "--out", "whole.npz", "--overwrite") == 0
        apart = md.read_motion("whole.npz").positions - md.read_motion("my_walk.bvh").positions
        moved = np.abs(apart).max((0, 2)) > 1e-4
        assert set(np.array(JOINTS)[moved]) == {"LeftHand", "LeftForeArm"}


def test_a_sentence_is_acted_and_edited_from_the_command_line(folder, capsys):
    words = ["act", "marches ahead, then squats", "--seconds", "3", "--samples", "2"]
    assert run(*words, "--seed", "4", "--out", "act.npz") == 0
    said = capsys.readouterr()
    assert "read as: walks forward, then squats\n" in said.err
    assert "act-2.npz: 3.0 s, 60 frames" in said.out and "'marches' is read as 'walk'" in said.err
    one, two = (md.read_motion(f"act-{k}.npz").positions for k in (1, 2))
    assert np.abs(one - two).max() > 0.05
    words = ["edit", "my_walk.bvh", "walks while clapping", "--keep", "lower body"]
    assert run(*words, "--out", "clap.npz") == 0
    given, made = (md.read_motion(name).positions for name in ("my_walk.bvh", "clap.npz"))
    apart = np.abs(given - made).max((0, 2))
    legs = [JOINTS.index(name) for name in ("Hips", "LeftFoot", "RightToeBase")]
    assert apart[legs].max() < 0.02 and apart[JOINTS.index("LeftHand")] > 0.05


@pytest.mark.parametrize(
    "words, wrong",
    [
        (["act", "does a cartwheel"], "act: .*'cartwheel'"),
        (["act", ""], "act: "),
        (["act", "walks", "--seconds", "12"], "act: seconds must be from 2 to 10"),
        (["edit", "my_walk.bvh", "walks", "--keep", "tail"], "edit: .*tail"),
        (["edit", "my_walk.bvh", "walks", "--strength", "2"], "edit: strength must be a number"),
        (["act", "walks", "--guidance", "1000"], "act: guidance must be a number from 0 to 20"),
        (["edit", "nothing.bvh", "walks"], "edit: .*nothing.bvh"),
    ],
)
def test_what_cannot_be_acted_or_edited_is_said(words, wrong, folder, capsys):
    assert run(*words, "--out", "x.npz") == 1
    assert re.search(wrong, capsys.readouterr().err) and not (folder / "x.npz").exists()


@pytest.mark.parametrize(
    "words",
    [
        ["edit", "my_walk.bvh", "walks"],
        ["walk", "my_walk.bvh", "--control", "1s 1"],
        ["inbetween", "my_walk.bvh", "--every", "10"],
        ["reconstruct", "my_walk.bvh", "--missing", "LeftHand"],
    ],
)
def test_the_file_that_is_read_is_never_replaced(words, folder, capsys):
    before = (folder / "my_walk.bvh").read_bytes()
    out = str(folder / "." / "my_walk.bvh")
    assert run(*words, "--out", out, "--overwrite") == 1
    assert "is the file that is read" in capsys.readouterr().err
    assert (folder / "my_walk.bvh").read_bytes() == before


def test_words_without_quotes_are_told_about(folder, capsys):
    assert run("act", "walks", "forward", "--out", "x.npz") == 2
    assert "does not know forward; a sentence or name of several words" in capsys.readouterr().err


def test_the_help_of_edit_says_the_default():
    assert f"(default: {STRENGTH:g})" in Path(edit.__file__).read_text(encoding="utf-8")


def test_the_help_of_dance_says_the_default(capsys):
    assert run("dance", "--help") == 0
    assert f"(default: {USUAL_GUIDANCE:g})" in capsys.readouterr().out


def test_samples_go_to_numbered_files(folder, capsys):
    words = ["inbetween", "my_walk.bvh", "--every", "10", "--samples", "2", "--out", "made.npz"]
    assert run(*words) == 0
    assert sorted(p.name for p in folder.glob("made*")) == ["made-1.npz", "made-2.npz"]
    one, two = md.read_motion("made-1.npz"), md.read_motion("made-2.npz")
    given = md.read_motion("my_walk.bvh")
    frames = [0, 10, 20, 30, 40, 49]
    np.testing.assert_array_equal(one.positions[frames], given.positions[frames])
    assert not np.array_equal(one.positions, two.positions)
    assert run(*words) == 1 and "made-1.npz exists already" in capsys.readouterr().err
    assert run(*words, "--overwrite") == 0


def test_a_folder_is_taken_file_by_file_and_a_bad_one_costs_no_other(folder, capsys):
    walks = folder / "walks"
    walks.mkdir()
    for name in ("one.bvh", "two.bvh"):
        shutil.copy("my_walk.bvh", walks / name)
    (walks / "broken.bvh").write_text("HIERARCHY")
    (walks / "notes.txt").touch()
    assert run("convert", "walks", "made", "--ending", "npz") == 1
    said = capsys.readouterr().err
    assert "left out: walks/broken.bvh: " in said and "1 of 3 files were left out" in said
    assert sorted(path.name for path in (folder / "made").iterdir()) == ["one.npz", "two.npz"]
    words = ["inbetween", "walks/one.bvh", "my_walk.bvh", "--at", "20-22,30", "--samples", "2"]
    assert run(*words, "--frames", "5-44", "--ending", ".npz", "--out", "between") == 0
    between = sorted((folder / "between").iterdir())
    assert [path.stem for path in between] == ["my_walk-1", "my_walk-2", "one-1", "one-2"]
    given = md.read_motion("my_walk.bvh")[5:45].positions
    for path in between:
        kept = (md.read_motion(path).positions == given).all((1, 2))
        assert np.flatnonzero(kept).tolist() == [0, 20, 21, 22, 30, 39]
    assert run("info", "walks") == 1 and "1 of 3 files cannot be read" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words, told",
    [
        (["my_walk.bvh", "twice/my_walk.bvh", "made"], "two files would be written to my_walk.bvh"),
        (["twice", "my_walk.bvh", "made.mp4"], "give its name, and --ending .mp4"),
        (["empty", "made"], "empty: no file in this folder can be read as a motion"),
        (["twice", "twice"], "is the file that is read"),
        (["twice", "made", "--ending", "docx"], "unknown ending .docx"),
    ],
)
def test_what_several_files_cannot_be_written_to_is_refused_before_any_work(
    words, told, no_work, capsys
):
    (no_work / "empty").mkdir()
    (no_work / "twice").mkdir()
    shutil.copy("my_walk.bvh", no_work / "twice")
    assert told in refused(["convert", *words], no_work, capsys)


def test_a_file_is_written_at_the_rate_that_is_asked_for(folder):
    assert run("convert", "my_walk.bvh", "fast.npz", "--fps", "60") == 0
    given, fast = md.read_motion("my_walk.bvh"), md.read_motion("fast.npz")
    assert fast.fps == 60 and len(fast) == 3 * (len(given) - 1) + 1
    np.testing.assert_allclose(fast.positions[::3], given.positions, atol=1e-5)


def test_missing_joints_are_found_from_the_command_line(folder, capsys):
    words = ["reconstruct", "my_walk.bvh", "--missing", ARM, "--frames", "20-30,41-41"]
    assert run(*words, "--out", "whole.npz") == 0
    assert "reconstructing 36 joint positions" in capsys.readouterr().err  # (11 + 1) * 3
    given, whole = md.read_motion("my_walk.bvh"), md.read_motion("whole.npz")
    changed = (given.positions != whole.positions).any(-1)
    assert changed.sum() == 36 and changed[20:31, 17:20].all() and changed[41, 17:20].all()


def test_an_npz_with_holes_needs_no_names(folder):
    given = md.read_motion("my_walk.bvh")
    known = given.all_but(["Head"], 12, 17)
    holes = np.where(known[..., None], given.positions, np.nan)
    md.Motion(holes).save("holes.npz")
    assert run("reconstruct", "holes.npz", "--out", "whole.npz") == 0
    whole = md.read_motion("whole.npz")
    assert whole.known.all()
    np.testing.assert_array_equal(whole.positions[known], given.positions[known])


def test_info_convert_and_play(folder, capsys):
    assert run("convert", "my_walk.bvh", "my_walk.npz") == 0
    assert run("info", "my_walk.npz", "my_walk.bvh") == 0
    said = capsys.readouterr().out
    # 49 steps of 5 cm; the pelvis sways about the path
    assert said.count("2.5 s, 50 frames at 20 frames/s") == 2 and "the root moves 2.4" in said
    assert said.count("in the file: 50 frames at 20 frames/s, 24 joints") == 1  # of the BVH
    assert "joints by the course's names: 21" in said and "other names" not in said
    assert run("play", "my_walk.bvh", "my_walk.npz", "--out", "page.html", "--no-open") == 0
    assert "<!doctype html>" in (folder / "page.html").read_text("utf-8")
    assert "the page is" in capsys.readouterr().out
    words = ["play", "my_walk.bvh", "--out", "page.html", "--no-open"]
    assert run(*words) == 1 and "exists already" in capsys.readouterr().err


WALK = ["walk", "my_walk.bvh", "--control", "1s 1", "--out", "x.bvh"]
MISTAKES = {
    "no such file": (["info", "nope.bvh"], "there is no file nope.bvh in"),
    "no motion": (["info", "song.wav"], "song.wav cannot be read as a motion"),
    "a png": (["convert", "pic.png", "x.bvh"], "there is no file pic.png"),
    "no song": (["dance", "my_walk.bvh", "--out", "x.bvh"], "is a motion (BVH), not sound"),
    "negative seconds": (
        ["dance", "song.wav", "--seconds", "-3", "--out", "x.bvh"],
        "seconds must be above 0",
    ),
    "an ending": (["convert", "my_walk.bvh", "x.docx"], "unknown ending .docx; use one of"),
    "no ending": (["convert", "my_walk.bvh", "x"], "the name has no ending; use one of .bvh"),
    "the input": (["convert", "my_walk.bvh", "my_walk.bvh"], "is the file that is read"),
    "a comma": (
        ["walk", "my_walk.bvh", "--control", "1s 1,2", "--out", "x.bvh"],
        "'1,2' is not a number; write a decimal point (character 4 of the control)",
    ),
    "no samples": ([*WALK, "--samples", "0"], "--samples must be a whole number of at least 1"),
    "no keyframes": (
        ["inbetween", "my_walk.bvh", "--every", "0", "--out", "x.bvh"],
        "every must be a whole number of at least 1",
    ),
    "no joint": (
        ["reconstruct", "my_walk.bvh", "--missing", "Tail", "--out", "x.bvh"],
        "reconstruct: no joint is called 'Tail'; the skeleton has Hips",
    ),
    "no pelvis": (
        ["reconstruct", "my_walk.bvh", "--missing", "Hips", "--out", "x.bvh"],
        "the pelvis (Hips) is not known in frame 0",
    ),
    "no such frames": (
        ["reconstruct", "my_walk.bvh", "--missing", "Head", "--frames", "40-80", "--out", "x.bvh"],
        "frames 40 to 80 are not within its 50 (0 to 49)",
    ),
    "no span": (
        ["reconstruct", "my_walk.bvh", "--missing", "Head", "--frames", "9-3", "--out", "x.bvh"],
        "--frames 9-3: 9 comes after 3",
    ),
    "frames of nothing": (
        ["reconstruct", "my_walk.bvh", "--frames", "3-9", "--out", "x.bvh"],
        "--frames needs --missing, which names the joints",
    ),
    "nothing missing": (["reconstruct", "my_walk.bvh", "--out", "x.bvh"], "lacks no joint"),
    "no page": (["play", "my_walk.bvh", "--out", "x.bvh"], "the page's name must end in .html"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_answered_in_words_and_writes_nothing(name, folder, capsys):
    words, told = MISTAKES[name]
    before = sorted(folder.iterdir())
    assert run(*words) == 1
    said = capsys.readouterr().err
    assert told in said and "Traceback" not in said
    assert sorted(folder.iterdir()) == before


def failing(how):
    def run(chosen):
        how()

    verb = ModuleType("verb")
    verb.run = run
    return verb


def named():
    raise MotionError("the walk has no feet")


def of_numpy():
    np.zeros(3) + np.zeros(4)


def of_a_key():
    return {}["root"]


@pytest.mark.parametrize("bug", [of_numpy, of_a_key, lambda: torch.zeros(2, 3).view(5)])
def test_a_bug_keeps_its_traceback(bug):
    with pytest.raises((ValueError, KeyError, RuntimeError)):
        _commands.run(failing(bug), Namespace(verb="walk"))


def test_an_error_of_the_projects_own_is_a_message(capsys):
    assert _commands.run(failing(named), Namespace(verb="walk")) == 1
    assert capsys.readouterr().err == "walk: the walk has no feet\n"


def test_a_drive_that_does_not_exist_is_told(folder, capsys, monkeypatch):
    monkeypatch.setattr(_files.Path, "exists", lambda path: path == Path("my_walk.bvh"))
    assert run(*WALK[:-1], "elsewhere/more.bvh") == 1
    assert f"there is no {folder.anchor}; choose another place" in capsys.readouterr().err


def test_the_name_of_a_file_need_not_be_utf_8(folder):
    name, page = b"M\xfcller.bvh", b"M\xfcller.html"  # from an archive of an older system
    try:
        os.rename("my_walk.bvh", name)
    except OSError:
        pytest.skip("this system takes no such name")
    words = [sys.executable, "-m", "motiondiff_edu", "convert", name, page]
    strict = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    strict |= {"PYTHONIOENCODING": "utf-8:strict"}
    done = subprocess.run(words, env=strict, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(b"M\xfcller.html: 2.5 s")
    with open(page, encoding="utf-8") as file:
        assert "M?ller" in file.read()


def test_ctrl_c_and_a_closed_pipe_end_any_verb_quietly(monkeypatch, capsys):
    for error, status in ((KeyboardInterrupt(), 130), (BrokenPipeError(), 1)):

        def stopped(_, error=error):
            raise error

        monkeypatch.setattr(doctor, "run", stopped)
        assert run("doctor") == status
    assert "Traceback" not in capsys.readouterr().err


def test_a_missing_package_says_what_to_do():
    words = _commands.message(ModuleNotFoundError("No module named 'torch'", name="torch"))
    assert "torch is not installed for" in words and "make" in words


def test_convert_takes_names_of_joints_and_a_frame_rate(folder, capsys):
    text = Path("my_walk.bvh").read_text().replace("LeftUpLeg", "zzz")
    Path("odd.bvh").write_text(text.replace("Frame Time: 0.05", "Frame Time: 1"))
    assert run("convert", "odd.bvh", "odd.npz") == 1
    assert "--file-fps" in capsys.readouterr().err
    assert run("convert", "odd.bvh", "odd.npz", "--file-fps", "20") == 1
    assert "no joint found for LeftUpLeg" in capsys.readouterr().err
    words = ["convert", "odd.bvh", "odd.npz", "--file-fps", "20", "--joints", "LeftUpLeg=zzz"]
    assert run(*words) == 0
    ours = md.read_motion("my_walk.bvh")
    np.testing.assert_allclose(md.read_motion("odd.npz").positions, ours.positions, atol=1e-9)
    assert run("convert", "odd.bvh", "two.npz", "--joints", "LeftUpLeg") == 1
    assert "write JOINT=NAME" in capsys.readouterr().err


def test_an_option_that_is_none_is_refused(folder, capsys):
    assert run(*WALK, "--speed", "3") == 2
    assert "walk does not know --speed 3; it has no option --speed" in capsys.readouterr().err
    assert run("walk", "my_walk.bvh") == 2


@pytest.mark.parametrize("verb", _commands.VERBS)
def test_help_has_an_example(verb, capsys):
    assert run(verb, "--help") == 0
    said = capsys.readouterr().out
    assert re.search(rf"example: .* {verb} ", said)


def test_help_is_there_before_anything_heavy():
    code = (
        "import sys\nfrom motiondiff_edu import __main__ as m\n"
        "try: m.main(['walk', '--help'])\nexcept SystemExit: pass\n"
        "print('torch' in sys.modules, 'numpy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "False False"


@pytest.mark.parametrize(
    "words, wanted",
    [
        ("3s 1.2; 4s 1.0 turn 0.6", [(3, 1.2, 0, 0), (4, 1.0, 0, 0.6)]),
        ("0.5s -1", [(0.5, -1, 0, 0)]),
        (" 2s  0 left .3 ;1s 1 right 0.2 turn -1; ", [(2, 0, 0.3, 0), (1, 1, -0.2, -1)]),
    ],
)
def test_control_in_words(words, wanted):
    assert control_words.parse(words) == wanted


@pytest.mark.parametrize(
    "words, at, told",
    [
        ("", 0, "the control is empty"),
        (" ; ", 0, "the control is empty"),
        ("3 1.2", 0, "a segment begins with its duration, as 3s, not '3'"),
        ("3s 1.2; 4s", 10, "the forward speed (m/s) is missing after the duration"),
        ("3s 1.2; 4s fast", 11, "'fast' is not a number"),
        ("3s 1.2 turn", 11, "a number is missing after 'turn'"),
        ("3s 1.2 up 4", 7, "'up' is not left, right or turn"),
        ("3s 1.2 left 1 right 2", 14, "'right': this speed is already given"),
        ("3s 1.2;; 4s 1", 7, "nothing between two semicolons"),
        ("3s nan", 3, "'nan' is not a finite number"),
        ("0s 1", 0, "a duration is above 0"),
        ("-2s 1", 0, "a duration is above 0"),
    ],
)
def test_words_that_are_no_control_are_marked_where_they_go_wrong(words, at, told):
    with pytest.raises(ValueError) as caught:
        control_words.parse(words)
    first, shown, mark, *_ = str(caught.value).splitlines()
    assert told in first and f"(character {at + 1} of the control)" in first
    assert shown == f"  {words}" and mark == f"  {' ' * at}^"


def interrupted(words: list[str], folder: Path, seen: str) -> tuple[int, str]:
    """The exit code and stderr of a command that gets Ctrl-C once it has said `seen`.

    Its stderr is a terminal, because a progress bar shows only there.
    """
    import fcntl  # none of these on Windows
    import pty
    import struct
    import termios

    terminal, end = pty.openpty()
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    process = subprocess.Popen(
        [sys.executable, "-m", "motiondiff_edu", *words],
        cwd=folder, stdout=subprocess.PIPE, stderr=end,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        # a shell starts background jobs with Ctrl-C ignored, and what they start inherits that
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    said = b""
    os.close(end)
    with suppress(OSError):  # the other end was closed: the command has ended
        while seen.encode() not in said:
            said += os.read(terminal, 1000)
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        while True:
            said += os.read(terminal, 1000)
    process.communicate(timeout=PATIENCE / 1000)
    os.close(terminal)
    return process.returncode, said.decode()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for another process")
def test_ctrl_c_ends_with_a_word_and_leaves_no_half_file(folder):
    """While it walks, and while it draws a film: both told by the progress bar.

    Both would take a fast machine far longer than it takes to press the keys.
    """
    control = np.tile([1.0, 0.0, 0.2], (1500, 1))
    md.Motion.of_clip(walk(control, seed=2)).save("long.npz")
    before = sorted(folder.iterdir())
    walking = ["walk", "my_walk.bvh", "--control", "90s 1.2", "--out", "more.bvh"]
    code, said = interrupted(walking, folder, "walking: ")
    assert "stopped" in said and "Traceback" not in said and code != 0
    code, said = interrupted(["convert", "long.npz", "film.gif"], folder, "drawing: ")
    assert "stopped" in said and "Traceback" not in said and code != 0
    assert sorted(folder.iterdir()) == before


def test_recordings_from_the_command_line(real_data, tmp_path, monkeypatch, capsys):
    """As in the README, on files of strangers; the warnings are notes, not lines of code."""
    monkeypatch.chdir(tmp_path)
    walk = str(real_data / "bvh" / "cmu_12_01_walk_pybvh.bvh")
    assert run("info", walk) == 0
    said = capsys.readouterr()
    assert "note: cmu_12_01_walk_pybvh: frame 0 is a calibration pose" in said.err
    assert run("walk", walk, "--control", "1s 1.0", "--out", "more.bvh") == 0
    song = str(real_data / "audio" / "nutcracker.ogg")
    assert run("dance", song, "--seconds", "2", "--out", "dance.bvh") == 0
    assert run("info", "more.bvh", "dance.bvh") == 0
    said = capsys.readouterr().out
    assert "1.0 s, 20 frames" in said and "2.0 s, 40 frames" in said
    broken = sorted((real_data / "bvh_odd_and_broken").glob("bad_*.bvh"))
    for path in broken:
        assert run("convert", str(path), "out.npz") in (0, 1)
        assert "Traceback" not in capsys.readouterr().err
        Path("out.npz").unlink(missing_ok=True)
    assert len(broken) > 15


def test_info_says_which_named_joints_were_taken_for_which(folder, capsys):
    truth = walk(np.tile([1.1, 0.0, 0.0], (61, 1)), seed=3).world()
    few = [k for k, name in enumerate(JOINTS) if "Toe" not in name]
    np.savez("keys.npz", positions=truth[:, few], names=[f"b_{JOINTS[k]}" for k in few], fps=20.0)
    assert command.main(["info", "keys.npz"]) == 0
    said = capsys.readouterr().out
    assert "in the file: 61 frames at 20 frames/s, 19 joints" in said
    assert "LeftUpLeg is b_LeftUpLeg" in said
    assert "computed from the others: LeftToeBase, RightToeBase" in said
