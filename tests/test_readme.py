"""The examples of README and docs do what they say, on small stand-ins for the reader's files."""

import re
import shlex

import numpy as np
import pytest
import soundfile
from code_blocks import blocks
from PIL import Image

import motiondiff_edu as md
from data_synth.music import compose
from data_synth.walking import walk
from motiondiff_edu.__main__ import VERBS, main
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.bvh.write import write_bvh
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.retarget import load_clip
from motiondiff_edu.pretrained.checkpoints import available

TEACHERS = ("TEACHING", "QUESTIONS", "CAPSTONE", "PILOT", "GLOSSARY")
PAGES = [
    "README.md",
    *(
        f"docs/{name}.md"
        for name in ("INSTALL", "USING", "FROM_OTHERS", "EXTENDING", "BLENDER", *TEACHERS)
    ),
]
WALKED, SUNG = 2.0, 2.0  # seconds of the stand-ins
SHIPPED = {"walker", "dancer", "inbetweener"}
pytestmark = pytest.mark.skipif(
    not SHIPPED <= set(available()), reason="not all weights are shipped: run make pretrained"
)


def with_files(place):
    """A folder, with the files that the examples read."""
    given = walk(constant_control(1.0, seconds=WALKED), seed=5).world()
    write_bvh(place / "my_walk.bvh", given)
    soundfile.write(place / "song.ogg", compose(3, "pop", seconds=SUNG).audio, 16_000)
    (place / "my_walks").mkdir()
    write_bvh(place / "my_walks" / "one.bvh", given)
    (place / "my_dances").mkdir()
    write_bvh(place / "my_dances" / "one.bvh", np.concatenate([given] * 3))  # 6 s
    soundfile.write(place / "my_dances" / "one.wav", compose(4, "pop", seconds=6.0).audio, 16_000)
    return place


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return with_files(tmp_path)


@pytest.fixture(scope="module")
def guide(root, tmp_path_factory):
    """What the examples of the guide have named, and the folder of their files."""
    place = with_files(tmp_path_factory.mktemp("guide"))
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        return run(root, "docs/USING.md"), place


def run(root, page: str) -> dict:
    """Run the Python examples of a page one after the other; what they have named.

    A training of 20,000 steps has two here, of small batches.
    """
    names: dict = {}
    for code in blocks(root, page, "python"):
        if "bpy" not in code and "io_anim_bvh" not in code:  # those are for Blender's own Python
            code = code.replace("20_000", "2").replace("draw(64,", "draw(3,")
            code = code.replace("draw(32,", "draw(3,")
            exec(compile(code, page, "exec"), names)
    return names


def test_three_lines_continue_a_recording(root, folder):
    made = run(root, "README.md")
    assert len(made["more"]) == 3 * 20
    clip = load_clip(folder / "more.bvh")
    assert len(clip) == 3 * 20 and clip.control[20:40, 0].mean() == pytest.approx(1.2, abs=0.1)
    assert {"act", "filled", "whole", "clapping"} <= made.keys()
    assert all(isinstance(made[name], Motion) for name in ("act", "filled", "whole", "clapping"))
    assert len(made["dance"]) == min(SUNG, 10) * 20


def test_the_examples_of_the_guide_run_in_order(guide):
    made, folder = guide
    walked, given = made["walk"].positions, made["known"]
    assert len(made["more"]) == 7 * 20
    assert load_clip(folder / "more.bvh").control[80:120, 2].mean() == pytest.approx(0.6, abs=0.1)
    assert len(made["dance"]) == SUNG * 20 and (folder / "dance.html").stat().st_size > 10_000
    keys = [one.positions[::20] for one in made["made"]]
    assert len(keys) == 3 and all(np.array_equal(key, walked[::20]) for key in keys)
    assert len(read_bvh(folder / "inbetween.bvh").frames) == WALKED * 20
    whole = made["whole"].positions
    assert np.array_equal(whole[given], walked[given]) and (~given).sum() == 20 * 4
    made_anew = np.linalg.norm(whole - walked, axis=-1)[~given]
    assert 0 < made_anew.mean() < 0.3  # another arm, near where an arm can be
    assert (folder / "whole.bvh").exists()
    assert len(made["motions"]) == 4 and (folder / "act.html").exists()
    assert len(made["clapping"]) == len(made["walk"])


def test_the_lines_for_training_write_a_walker_and_a_dancer_that_perform(root, guide):
    made, folder = guide
    assert made["step"].step == 2
    walker, dancer = (md.load(folder / f"my_{name}.safetensors") for name in ("walker", "dancer"))
    more = walker.walk(made["walk"], md.joystick([(0.5, 1, 0, 0)]), progress=False)
    assert len(more) == 10
    assert len(dancer.dance(folder / "song.ogg", steps=2, progress=False)) == SUNG * 20
    # the same lines in both pages, each copied as it stands
    (ours,) = (code for code in blocks(root, "README.md", "python") if "train_steps(" in code)
    assert ours in blocks(root, "docs/USING.md", "python")
    assert "my_walker" in ours and (folder / "my_walker.json").is_file()


def test_the_example_for_blender_writes_its_file(root, folder):
    made = run(root, "docs/BLENDER.md")
    assert len(read_bvh(folder / "more.bvh").frames) == len(made["more"]) == 5 * 20


@pytest.mark.parametrize("page, count", [("README.md", 3), ("docs/USING.md", 6)])
def test_the_commands_write_their_files(root, folder, page, count):
    lines = [line for block in blocks(root, page, "") for line in block.splitlines()]
    commands = [shlex.split(line) for line in lines if line.startswith("motiondiff-edu ")]
    assert len(commands) == count
    for _, *arguments in commands:
        assert main(arguments) in (0, None)
        out = folder / arguments[arguments.index("--out") + 1]
        numbered = sorted(folder.glob(f"{out.stem}-?{out.suffix}"))  # with --samples
        assert all(one.stat().st_size > 10_000 for one in numbered or [out])
    walked = folder / commands[0][commands[0].index("--out") + 1]
    parts = re.findall(r"([\d.]+)s", " ".join(commands[0]))
    assert len(read_bvh(walked).frames) == 20 * sum(map(float, parts))


@pytest.mark.parametrize("page", ["README.md", "docs/USING.md"])
def test_a_page_read_from_top_to_bottom_writes_no_file_twice(root, page):
    # a command refuses a file that exists, and the Python above it has been pasted, too
    text = (root / page).read_text(encoding="utf-8")
    written = re.findall(r"""save\("([^"]+)"\)|--out (\S+?)[\s`]""", text)
    names = [saved or out for saved, out in written]
    assert len(names) > 3 and len(set(names)) == len(names), names


def test_the_block_to_paste_comes_first_and_the_links_lead_somewhere(root):
    text = (root / "README.md").read_text(encoding="utf-8")
    before = re.sub(r"!\[.*?\]\(.*?\)", "", text.split("make lab\n")[0], flags=re.S)
    assert len(before.split()) < 60
    for page in PAGES:
        links = re.findall(r"\]\(([^)#]+)", (root / page).read_text(encoding="utf-8"))
        local = [link for link in links if not link.startswith("http")]
        assert local or page in ("docs/BLENDER.md", "docs/CAPSTONE.md")
        assert [link for link in local if not ((root / page).parent / link).exists()] == []


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_exist(root, page):
    text = (root / page).read_text(encoding="utf-8")
    verbs = set(re.findall(r"(?:motiondiff-edu|python -m motiondiff_edu) ([a-z]+)", text))
    assert verbs <= set(VERBS)
    targets = set(re.findall(r"(?:^|`)make ([a-z]+)", text, re.M))
    assert targets <= set(re.findall(r"^([a-z]+):", (root / "Makefile").read_text("utf-8"), re.M))


def test_the_table_names_the_notebooks_there_are(root):
    text = (root / "README.md").read_text(encoding="utf-8")
    there = sorted(path.name[:2] for path in (root / "notebooks").glob("[0-9]*.ipynb"))
    assert re.findall(r"^\| (\d\d) \|", text, re.M) == there


def test_the_moving_picture_moves_and_is_light(root):
    (name,) = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", (root / "README.md").read_text("utf-8"))
    path = root / name
    assert path.stat().st_size < 2.5e6
    with Image.open(path) as picture:
        assert 900 <= picture.width <= 1000 and picture.info["loop"] == 0
        shown = []
        for k in range(picture.n_frames):
            picture.seek(k)
            picture.load()
            shown.append(picture.info["duration"])
        assert 4_000 <= sum(shown) <= 6_000
