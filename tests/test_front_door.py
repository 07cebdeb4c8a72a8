"""The front door as a stranger uses it: three lines each, on files of their own; and what they are
told when it cannot be."""

import json
import subprocess
import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest
import torch
from as_typed import outcomes

import motiondiff_edu as md
from data_synth.music import compose
from data_synth.walking import walk
from motiondiff_edu.__main__ import main
from motiondiff_edu.conditions import clip
from motiondiff_edu.editing.masks import body_part
from motiondiff_edu.editing.plausible import CALMER, DRAWS
from motiondiff_edu.motion.motion import MotionError, MotionWarning
from motiondiff_edu.motion.root_frame import FPS
from motiondiff_edu.motion.skeleton import HIPS, TOES, Skeleton, joint_index
from motiondiff_edu.performers.inbetweener import Inbetweener
from motiondiff_edu.pretrained import checkpoints, shipped
from motiondiff_edu.pretrained.shipped import LEARNT
from motiondiff_edu.recipes.inbetweener import INBETWEENER
from motiondiff_edu.widgets import motions as shown
from motiondiff_edu.widgets.player import Player

CONTROL = np.tile([1.2, 0.0, 0.0], (20, 1))
SOUND = compose(3, "house", seconds=2.0).audio
ARM = ("RightArm", "RightForeArm", "RightHand", "RightHandIndex1")


@pytest.fixture(scope="module")
def walked() -> md.Motion:
    """Five seconds that turn to the left, where and how they are known."""
    control = np.tile([1.2, 0.0, 0.3], (100, 1))
    return md.Motion.of_clip(walk(control, seed=12, style="neutral"), (1.0, 2.0, 0.5))


@pytest.fixture
def folder(tmp_path, monkeypatch, walked, capsys):
    """A folder with a walk of one's own, entered."""
    monkeypatch.chdir(tmp_path)
    walked.save("my_walk.bvh")
    capsys.readouterr()
    return tmp_path


def bone_lengths(motion: md.Motion) -> np.ndarray:
    parents = np.array(motion.skeleton.parents[1:])
    return np.linalg.norm(motion.positions[:, 1:] - motion.positions[:, parents], axis=-1)


def test_a_walk_is_continued(folder):
    walk = md.read_motion("my_walk.bvh")
    more = md.load("walker").walk(walk, md.joystick([(3, 1.2, 0, 0)]), seed=0)
    more.save("more.bvh")
    assert len(more) == 60 and more.fps == 20 and (folder / "more.bvh").is_file()
    step = more.positions[0, HIPS] - walk.positions[-1, HIPS]
    assert 0.02 < np.linalg.norm(step) < 0.12  # metres: the next frame at 1.2 m/s is 6 cm on
    way = np.linalg.norm(more.positions[-1, HIPS] - more.positions[0, HIPS])
    assert abs(way - 1.2 * 59 / 20) < 0.25
    before, after = walk.root[-1, 2], more.root[0, 2]
    assert abs(after - before) < 0.05  # radians: it faces where the walk faced
    assert np.abs(bone_lengths(more) - bone_lengths(walk)[0]).max() < 0.04
    both = walk.then(more)
    assert len(both) == 160 and np.isfinite(both.control).all()
    np.testing.assert_allclose(both.control[-50:-1], [[1.2, 0, 0]] * 49, atol=1e-9)


def test_a_continuation_is_drawn_by_its_seed(walked):
    walker, control = md.load("walker"), md.joystick([(0.5, 1.2, 0, 0)])
    one = walker.walk(walked, control, seed=1)
    same, other = walker.walk(walked, control, seed=1), walker.walk(walked, control, seed=2)
    np.testing.assert_array_equal(one.positions, same.positions)
    assert not np.array_equal(one.positions, other.positions)
    three = walker.walk(walked, control, samples=3)
    assert len(three) == 3 and not np.array_equal(three[0].positions, three[1].positions)
    longer = walker.walk(walked, control, seconds=0.8)
    assert len(longer) == 16 and len(walker.walk(walked, control, seconds=0.3)) == 6
    np.testing.assert_allclose(longer.control[-8:-1], np.tile(control[-1], (7, 1)), atol=1e-9)


def test_a_motion_at_another_rate_is_continued(walked):
    more = md.load("walker").walk(walked.resampled(60), md.joystick([(0.5, 1.2, 0, 0)]))
    assert more.fps == 20 and len(more) == 10
    assert np.linalg.norm(more.positions[0, HIPS] - walked.positions[-1, HIPS]) < 0.12


def test_a_song_is_danced_to(folder):
    sound = compose(3, "latin", seconds=6).audio
    song = md.load("dancer").dance(sound, sample_rate=16_000, seconds=2, seed=0)
    song.save("song.npz")
    assert len(song) == 40 and len(song.audio) == 32_000
    back = md.read_motion("song.npz")
    np.testing.assert_array_equal(back.audio, sound[:32_000].astype(np.float32))


def test_what_lies_between_keyframes_is_made(walked):
    known = md.keyframes(walked, every=20)
    assert known.shape == (100, 21) and known[0].all() and known[99].all() and known.sum() == 6 * 21
    made = md.inbetween(walked, known, samples=2, steps=10)
    assert len(made) == 2 and not np.array_equal(made[0].positions, made[1].positions)
    for one in made:
        np.testing.assert_array_equal(one.positions[known], walked.positions[known])
        assert np.isfinite(one.positions).all()
    assert isinstance(md.inbetween(walked[:7], md.keyframes(7, every=3), steps=3), md.Motion)
    walker = md.load("walker")
    ahead, numbers = np.array([[1.0, 0.0, 0.0]]), (walker.schedule.S, 10**6)
    every = [walker.walk(walked, ahead, steps=n) for n in numbers]
    np.testing.assert_array_equal(every[0].positions, every[1].positions)


def straight_lines(motion: md.Motion, known: np.ndarray) -> np.ndarray:
    """Each joint's way about the pelvis, straight through its holes."""
    frames, about = np.arange(len(motion)), motion.positions - motion.positions[:, :1]
    lines = np.copy(about)
    for joint in range(21):
        given = known[:, joint]
        for axis in range(3):
            lines[:, joint, axis] = np.interp(frames, frames[given], about[given, joint, axis])
    return lines + motion.positions[:, :1]


def error_cm(found: np.ndarray, motion: md.Motion, known: np.ndarray) -> float:
    away = np.linalg.norm(found - motion.positions, axis=-1)[~known]
    return float(100 * np.sqrt((away**2).mean()))


def test_a_missing_arm_is_found_again(walked):
    """Known joints come back bit by bit; the arm is nearer than on straight lines, and joins.

    An arm that swings: one that is raised in its hole only can be found by nobody.
    """
    known = walked.all_but(ARM, 30, 65)
    known[80:83, 1:] = False  # and three frames of all but the pelvis
    holes = md.Motion(np.where(known[..., None], walked.positions, np.nan))
    whole = md.reconstruct(holes, known)
    np.testing.assert_array_equal(whole.positions[known], walked.positions[known])
    assert whole.known.all()
    lines = error_cm(straight_lines(walked, known), walked, known)
    assert lines > 8 and error_cm(whole.positions, walked, known) < 0.6 * lines
    wrong = 20 * np.linalg.norm(np.diff(whole.positions - walked.positions, axis=0), axis=-1)
    edges = known[1:] != known[:-1]
    assert wrong[edges].max() < 0.8  # m/s too much or too little where a hole begins or ends
    assert np.abs(bone_lengths(whole) - bone_lengths(walked)[0]).max() < 0.03


def test_a_long_motion_is_mended_wherever_it_is_broken():
    """Half a minute with holes at its start, across its middle and at its end."""
    control = np.tile([0.9, 0.0, 0.2], (600, 1))
    motion = md.Motion.of_clip(walk(control, seed=5))
    known = motion.all_but(ARM, 0, 25) & motion.all_but(["LeftLeg", "LeftFoot"], 290, 330)
    known &= motion.all_but(["Head", "Neck1", "LeftHand"], 580, 600)
    holes = md.Motion(np.where(known[..., None], motion.positions, np.nan))
    whole = md.reconstruct(holes, known)
    np.testing.assert_array_equal(whole.positions[known], motion.positions[known])
    for first, last in ((0, 25), (290, 330), (580, 600)):
        part = slice(first, last)
        away = error_cm(whole.positions[part], motion[part], known[part])
        assert away < 12, (first, away)


def test_a_reconstruction_is_drawn_by_its_seed(walked):
    known = walked.all_but(ARM, 40, 50)
    first, same, other = (md.reconstruct(walked, known, seed=k).positions for k in (0, 0, 1))
    both = md.reconstruct(walked, known, samples=2)
    np.testing.assert_array_equal(both[0].positions, first)
    assert len(both) == 2 and not np.array_equal(both[1].positions, first)
    np.testing.assert_array_equal(first, same)
    assert not np.array_equal(first, other)


def test_a_reconstruction_keeps_the_root_and_so_the_control(walked):
    given = replace(walked, root=walked.path())
    made = md.reconstruct(given, given.all_but("LeftArm"))
    np.testing.assert_array_equal(made.root, given.root)
    np.testing.assert_array_equal(made.control, given.control)


def test_in_betweens_without_a_pelvis_have_a_root_of_their_own(walked):
    given = replace(walked, root=walked.path())
    gap = given.known
    gap[20:30] = False
    assert md.inbetween(given, gap, steps=2).root is None


def test_a_foot_that_was_made_anew_has_no_contacts(walked):
    hand, foot = walked.all_but(ARM, 40, 44), walked.all_but(["LeftToeBase"], 40, 44)
    np.testing.assert_array_equal(md.reconstruct(walked, hand).contacts, walked.contacts)
    assert joint_index("LeftToeBase") in TOES and md.reconstruct(walked, foot).contacts is None


def test_a_motion_shows_itself_as_a_player(walked):
    bundle, _ = walked._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in bundle and "image/png" in bundle
    assert bundle["text/plain"] == repr(walked)
    broken = md.Motion(np.where(np.arange(100)[:, None, None] == 4, np.nan, walked.positions))
    assert broken._repr_mimebundle_() == {"text/plain": repr(broken)}


def test_play_shows_several_side_by_side(walked, tmp_path, capsys):
    song = md.Motion(walked.positions[:40], audio=np.zeros(16_000, np.float32), sample_rate=16_000)
    page = md.play(walked, [song, walked[:10]], path=tmp_path / "p.html", open_page=False)
    assert page == (tmp_path / "p.html").resolve() and str(page) in capsys.readouterr().out
    assert "<!doctype html>" in page.read_text("utf-8")
    player = shown.player_of([walked, song, walked.resampled(60)], ["a", "b", "c"])
    figures = player.scene["figures"]
    assert [figure["frames"] for figure in figures] == [100, 40, 100]
    assert [figure["label"] for figure in figures] == ["a", "b", "c"]


def test_notes_are_below_the_player_each_with_the_name_of_its_motion(walked, tmp_path):
    one = replace(walked, notes=("mended", "mended", "doubtful"))
    assert shown.player_of([walked]).notes == []
    assert shown.player_of([one]).notes == ["mended", "doubtful"]
    other = replace(walked, source="", notes=("sunk", "mended"))
    several = shown.player_of([one, other]).notes
    names = f"{walked.source}, figure 2"
    assert several == [f"{names}: mended", f"{walked.source}: doubtful", "figure 2: sunk"]
    assert shown.player_of([one, walked], ["a", "b"]).notes[0] == "a: mended"
    odd = replace(walked[:5], notes=("</script><b>",)).save(tmp_path / "odd.html")
    assert '"notes": ["\\u003c/script>\\u003cb>"]' in odd.read_text("utf-8")


def test_contacts_are_not_drawn_at_the_joints_of_another_skeleton(walked):
    contacts = np.ones((len(walked), 2), bool)
    (ours,) = shown.player_of([replace(walked, contacts=contacts)]).scene["figures"]
    few = md.Motion(
        walked.positions[:, :5],
        skeleton=Skeleton(tuple("abcde"), (-1, 0, 1, 2, 3)),
        contacts=contacts,
    )
    (other,) = shown.player_of([few]).scene["figures"]
    assert ours["contacts"] and not other["contacts"]
    bundle, _ = few._repr_mimebundle_()
    assert "image/png" in bundle


def test_a_performer_says_which_other_one_can():
    with pytest.raises(AttributeError, match="a walker cannot dance; md.load..dancer.. can"):
        md.load("walker").dance("song.ogg")
    with pytest.raises(AttributeError, match="a dancer cannot walk; md.load..walker.. can"):
        md.load("dancer").walk(None, None)
    with pytest.raises(AttributeError, match="an inbetweener cannot dance; md.load..dancer.. can"):
        md.load("inbetweener").dance("song.ogg")
    with pytest.raises(AttributeError, match="a walker cannot fill; md.load..inbetweener.. can"):
        md.load("walker").fill(None, None)
    with pytest.raises(AttributeError, match="'Dancer' object has no attribute 'sing'"):
        md.load("dancer").sing()


def test_motions_of_one_name_are_numbered(walked):
    player = shown.player_of([walked, replace(walked, source="other"), walked])
    labels = [figure["label"] for figure in player.scene["figures"]]
    assert labels == [f"{walked.source} (1)", "other", f"{walked.source} (2)"]


@pytest.mark.parametrize(
    "better, said", [(True, "So it was generated again"), (False, "no better")]
)
def test_in_betweens_that_jump_are_made_again(better, said, walked, monkeypatch):
    """The network is replaced by one that leaves the way, at first or always."""
    drawn = []

    def astray(inbetweener, positions, known, *, samples, **_):
        made = np.stack([positions] * samples)
        if not (better and drawn):
            made[:, 30:35] += 2.0
        drawn.append(inbetweener.card["name"])
        return made

    monkeypatch.setattr(Inbetweener, "fill", astray)
    monkeypatch.setattr(shipped, "clean_samples", lambda made, *_: made)
    with pytest.warns(MotionWarning, match=f"between frames 20 and 40, where 1.* m/s.*{said}"):
        made = md.inbetween(walked, md.keyframes(walked), progress=False)
    assert np.array_equal(made.positions, walked.positions) == better
    assert "between frames 20 and 40, where 1" in made.notes[0] and said in made.notes[0]
    assert set(drawn) == {"inbetweener"} and len(drawn) == (2 if better else DRAWS + len(CALMER))


def test_in_betweens_note_where_they_leave_what_was_given(walked, monkeypatch):
    """A hand is raised between two keyframes in one sample of two; the other is as given."""

    def raised(inbetweener, positions, known, *, samples, **_):
        made = np.stack([positions] * samples)
        made[-1, 20:41, joint_index("RightHand"), 1] += np.sin(np.linspace(0, np.pi, 21))
        return made

    monkeypatch.setattr(Inbetweener, "fill", raised)
    monkeypatch.setattr(shipped, "clean_samples", lambda made, *_: made)
    told = replace(walked, notes=("the feet were planted anew",))
    with pytest.warns(MotionWarning) as warned:
        good, other = md.inbetween(told, md.keyframes(walked), samples=2, progress=False)
    assert good.notes == told.notes
    before, reach = other.notes
    assert reach.startswith("RightHand goes ") and " above where the given motion " in reach
    assert (before,) == told.notes
    assert [str(one.message) for one in warned] == [f"{other.name}: {reach}"]


@pytest.mark.parametrize(
    "make",
    [
        lambda motion, n: md.load("walker").walk(motion, CONTROL, samples=n, progress=False),
        lambda motion, n: md.load("dancer").dance(
            SOUND, samples=n, sample_rate=16_000, steps=3, progress=False
        ),
        lambda motion, n: md.inbetween(
            motion, md.keyframes(motion), samples=n, steps=3, progress=False
        ),
        lambda motion, n: md.reconstruct(
            motion, motion.all_but(["LeftHand"], 20, 25), samples=n, progress=False
        ),
    ],
    ids=["walk", "dance", "inbetween", "reconstruct"],
)
def test_the_first_of_several_samples_is_the_sample_alone(make, walked):
    alone, (first, second) = make(walked, 1), make(walked, 2)
    assert np.abs(first.positions - alone.positions).max() < 1e-4
    assert np.abs(second.positions - alone.positions).max() > 1e-2


@pytest.mark.parametrize(
    "make, told",
    [
        (lambda w: md.inbetween(w, md.keyframes(w), seed=-1), "seed must be"),
        (lambda w: md.inbetween(w, md.keyframes(w), samples=0), "samples must be"),
        (lambda w: md.reconstruct(w, w.all_but("Head"), seed=-1), "seed must be"),
        (lambda w: md.edit(w, "waves", seed=-1), "seed must be"),
        (lambda w: md.edit(w, "waves", strength=2), "strength must be"),
    ],
)
def test_numbers_are_checked_before_weights_are_loaded(make, told, walked, monkeypatch):
    monkeypatch.setattr(shipped, "_shipped", lambda kind: pytest.fail(f"{kind} was loaded"))
    with pytest.raises(ValueError, match=told):
        make(walked)


@pytest.mark.parametrize(
    "name, told",
    [("~nouser/a.bvh", "~nouser/a.bvh: nobody here"), ("ftp://b.org/a.ogg", "is an address: down")],
)
def test_a_place_that_is_none_here_is_said(name, told, walked, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dance = md.load("dancer").dance
    for call in (md.read_motion, md.read_motions, walked.save, dance, md.load, clip.load):
        with pytest.raises(FileNotFoundError, match=told):
            call(name)
    assert main(["info", name]) == 1 and not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "make",
    [
        lambda walked: md.load("walker").walk(walked, CONTROL),
        lambda walked: md.load("dancer").dance(SOUND, sample_rate=16_000),
        lambda walked: md.load("mover").act("walks forward"),
        lambda walked: md.inbetween(walked[:40], md.keyframes(walked[:40], every=20)),
        lambda walked: md.reconstruct(walked[:40], walked[:40].all_but(list(ARM))),
        lambda walked: md.edit(walked[:40], "walks forward while clapping"),
    ],
)
@pytest.mark.filterwarnings("ignore::motiondiff_edu.motion.motion.MotionWarning")
def test_another_default_type_of_torch_makes_the_same_motion(make, walked, monkeypatch):
    usual = make(walked)
    checkpoints._kept.cache_clear()  # so that the weights are read once more
    torch.set_default_dtype(torch.float64)
    try:
        again = make(walked)
        assert torch.get_default_dtype() == torch.float64
    finally:
        torch.set_default_dtype(torch.float32)
    np.testing.assert_allclose(again.positions, usual.positions, atol=1e-4)


def test_a_figure_that_lies_is_not_continued(walked):
    lying = md.Motion(walked.positions[..., [0, 2, 1]] * [1, -1, 1])
    with pytest.raises(MotionError, match=r"lies along z, but y points up: try positions"):
        md.load("walker").walk(lying, CONTROL[:2], progress=False)


def test_a_performer_is_shown_in_one_line():
    for name, begins in (("walker", "Walker 'walker': MoDiff of 1,4"), ("mover", "Mover")):
        assert repr(md.load(name)).startswith(begins) and len(repr(md.load(name))) < 150


@pytest.mark.parametrize("sliding", [0, 1, 2])
def test_an_edit_that_slides_is_told_of_in_whichever_sample(walked, monkeypatch, sliding):
    still = np.repeat(walked.positions[:1], len(walked), 0)
    gliding = still + np.linspace(0, 4, len(still))[:, None, None] * [1.0, 0.0, 0.0]
    made = np.stack([gliding if k >= 2 - sliding else still for k in range(2)])
    monkeypatch.setattr(shipped.by_words, "edit_by_words", lambda *_, **__: made)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        md.edit(walked, "walks forward", samples=2, progress=False)
    told = [str(one.message) for one in caught if "both feet slide" in str(one.message)]
    assert len(told) == bool(sliding)
    assert all(f"({sliding} of 2 samples)" in words for words in told)


def test_an_edit_has_the_bones_of_the_motion(walked):
    known = body_part(len(walked), "lower body")
    made = md.edit(walked, "waves with the left hand", known, progress=False)
    assert np.array_equal(made.positions[known], walked.positions[known])
    lengths = bone_lengths(walked)
    assert np.abs(bone_lengths(made) - lengths).max() < 5e-3


def test_what_is_made_of_nothing_has_bones_of_one_length(walked):
    nothing = np.zeros_like(walked.known)
    with pytest.warns(MotionWarning, match="no joint is known"):
        made = md.inbetween(walked, nothing, steps=10, progress=False)
    assert bone_lengths(made).std(0).max() < 1e-3


@pytest.mark.parametrize("part", ["upper body", "lower body", "trajectory"])
def test_bones_that_are_nowhere_given_suit_the_others(walked, part):
    tall = md.Motion(1.1 * walked.positions, walked.fps)
    made = md.inbetween(tall, body_part(len(tall), part), steps=10, progress=False)
    lengths = bone_lengths(made)
    assert lengths.std(0).max() < 1e-3
    size = 1.0 if part == "trajectory" else 1.1  # a path does not tell the size
    np.testing.assert_allclose(lengths.mean(0), size * bone_lengths(walked)[0], atol=2e-3)


def test_what_is_known_of_nothing_is_noted(walked):
    nothing = np.zeros_like(walked.known)
    with pytest.warns(MotionWarning, match="no joint is known, so the result has nothing to do"):
        made = md.inbetween(walked, nothing, steps=2, progress=False)
    assert made.notes == ("no joint is known, so the result has nothing to do with this motion",)


def test_a_jump_from_one_part_to_the_next_is_told(walked):
    aside = replace(walked, positions=walked.positions + 2.0, root=None)
    with pytest.warns(MotionWarning, match="the figure jumps by"):
        walked.then(aside)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        walked[:50].then(walked[50:])


def test_another_song_gets_another_dance_although_the_seed_is_the_same():
    """About as different as with another seed; with the same noise it was half of that."""
    songs = [compose(k, genre, seconds=5.0).audio for k, genre in enumerate(("house", "latin"))]
    options = {"sample_rate": 16_000, "steps": 10, "progress": False}
    ours = [md.load("dancer").dance(songs[0], seed=seed, **options).positions for seed in range(4)]
    others = [md.load("dancer").dance(songs[1], seed=seed, **options).positions for seed in (0, 1)]

    def apart(a, b):
        return np.linalg.norm((a - a[:, :1]) - (b - b[:, :1]), axis=-1).mean()

    by_seed = np.mean([apart(ours[0], ours[1]), apart(ours[2], ours[3])])
    by_song = np.mean([apart(ours[0], others[0]), apart(ours[1], others[1])])
    assert by_song > 0.7 * by_seed, (by_song, by_seed)


def test_an_npz_without_a_frame_rate_or_in_centimetres_is_noted(walked, tmp_path):
    np.savez(tmp_path / "bare.npz", positions=100 * walked.positions)
    with pytest.warns(MotionWarning) as notes:
        md.read_motion(tmp_path / "bare.npz")
    said = " ".join(str(note.message) for note in notes)
    assert "no `fps`; 20 frames/s are assumed" in said and "in centimetres; they are read" in said
    for unit, many in (("millimetres", 1000), ("inches", 39.37)):
        np.savez(tmp_path / "other.npz", positions=many * walked.positions, fps=[20])
        with pytest.warns(MotionWarning, match=f"are in {unit}; they are read in metres"):
            read = md.read_motion(tmp_path / "other.npz")
        np.testing.assert_allclose(read.positions, walked.positions, atol=1e-9)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        ours = md.Motion(1000 * walked.positions)
    ours.save(tmp_path / "ours.npz")
    with pytest.warns(MotionWarning, match=r"Millimetres\? Then pass 0.001 \* positions"):
        md.read_motion(tmp_path / "ours.npz")


@pytest.mark.parametrize(
    "fps, told", [(0.05, r"fps is 0.05 .* write fps = 20"), ([20, 20], "fps must be one number")]
)
def test_a_rate_that_is_none_is_refused(walked, tmp_path, fps, told):
    np.savez(tmp_path / "rate.npz", positions=walked.positions, fps=fps)
    with pytest.raises(MotionError, match=told):
        md.read_motion(tmp_path / "rate.npz")


def test_frames_that_a_file_lacks_are_filled_in(walked):
    lost = walked.positions.copy()
    lost[8:12] = np.nan
    lost[20, 0] = np.nan
    motion = md.Motion(lost)
    known = md.keyframes(motion, every=1)
    assert known.sum(1).tolist() == [0 if t in (8, 9, 10, 11, 20) else 21 for t in range(len(lost))]
    with pytest.raises(MotionError, match=r"md\.keyframes\(motion, every=1\)"):
        md.reconstruct(motion, motion.known)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)
        filled = md.inbetween(motion, known, steps=2)
    np.testing.assert_array_equal(filled.positions[known], lost[known])
    assert np.linalg.norm(filled.positions - walked.positions, axis=-1).max() < 0.3


def test_the_nearest_frame_takes_the_place_of_a_keyframe_that_a_file_lacks(walked):
    lost = walked.positions.copy()
    n = len(lost)
    lost[:3] = lost[18:26] = lost[n - 2 :] = np.nan
    lost[40, 5] = np.nan
    known = md.keyframes(md.Motion(lost), every=20)
    wanted = [3, 17, *range(40, n - 2, 20), n - 3]
    assert np.flatnonzero(known.any(1)).tolist() == sorted(set(wanted))
    assert known[40].tolist() == [joint != 5 for joint in range(21)]


def test_keyframes_farther_apart_than_in_the_training_are_told(walked):
    still = md.Motion(np.repeat(walked.positions[:1], 130, 0))
    apart = round(LEARNT * FPS)
    assert apart == INBETWEENER.frames
    with warnings.catch_warnings():
        warnings.simplefilter("error", MotionWarning)
        md.inbetween(still[: apart + 1], md.keyframes(apart + 1, every=apart), steps=2)
    with pytest.warns(MotionWarning, match="given frames are 6.0 s apart, and the network has le"):
        md.inbetween(still, md.keyframes(130, every=120), steps=2)


def test_play_in_a_notebook_displays_a_player(walked, monkeypatch):
    import IPython.display

    seen = []
    monkeypatch.setattr(shown, "_in_a_notebook", lambda: True)
    monkeypatch.setattr(IPython.display, "display", seen.append)
    assert md.play(walked, walked) is None
    (player,) = seen
    assert isinstance(player, Player) and len(player.scene["figures"]) == 2


@pytest.mark.parametrize("ending, begins", [("gif", b"GIF89a"), ("html", b"<!doc"), ("mp4", None)])
def test_films_and_pages_are_written_whole(ending, begins, walked, tmp_path):
    short = md.Motion(walked.positions[:6], audio=np.zeros(4_800, np.float32), sample_rate=16_000)
    path = short.save(tmp_path / f"walk.{ending}")
    head = path.read_bytes()[:12]
    assert head.startswith(begins) if begins else b"ftyp" in head
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_importing_it_imports_nothing_heavy():
    code = (
        "import sys; before = set(sys.modules); import motiondiff_edu as md; "
        "now = lambda: sorted({n.split('.')[0] for n in set(sys.modules) - before}); "
        "early, listed = now(), dir(md); md.read_motion, md.load; later = now(); "
        "later += ['scipy.signal'] * ('scipy.signal' in sys.modules); "
        "import torch, motiondiff_edu.conditions.audio_files as _; "
        "import motiondiff_edu.conditions.music as m; "
        "m.log_mel(torch.zeros(600), 16_000); heard = now(); "
        "import json; print(json.dumps([early, listed, later, heard]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    early, listed, later, heard = json.loads(done.stdout)
    assert set(early) - sys.stdlib_module_names == {"motiondiff_edu"}
    slow = {"matplotlib", "ipywidgets", "anywidget", "librosa", "PIL", "scipy.signal"}
    assert not slow & set(later), "each takes as long as half of torch, or more"
    assert not {"librosa", "numba", "soundfile"} & set(heard), "listening needs none of them"
    assert set(md.__all__) <= set(listed)


def test_every_name_of_the_front_door_is_there():
    assert sorted(md.__all__) == sorted(
        "Motion read_motion read_motions load joystick keyframes inbetween reconstruct edit "
        "play".split()
    )
    assert all(callable(getattr(md, name)) for name in md.__all__)
    with pytest.raises(AttributeError, match="no attribute 'dance'"):
        md.dance  # noqa: B018


SETUP = """
from data_synth.walking import walk
from motiondiff_edu.motion.skeleton import Skeleton
control = np.tile([1.0, 0, 0], (30, 1))
w = md.Motion.of_clip(walk(control, seed=1))
ahead = md.joystick([(0.5, 1, 0, 0)])
known = w.all_but("Head", 5, 9)
stick = md.Motion(np.zeros((4, 2, 3)), 20, Skeleton(("a", "b"), (-1, 0)))
huge = md.Motion(100 * w.positions)
nan = md.Motion(np.where(known[..., None], w.positions, np.nan))
open("walk.png", "wb").write(b"png")
np.savez("flat.npz", positions=np.zeros((2, 63)))
walker = lambda: md.load("walker")
dancer = lambda: md.load("dancer")
"""
# code as it is typed: what it is answered
TOLD = {
    'md.read_motion("nope.bvh")': "FileNotFoundError: there is no file nope.bvh in ",
    'md.read_motion("walk.png")': "walk.png cannot be read as a motion; .bvh, .npy, .npz and .pkl",
    'md.read_motion("flat.npz")': "flat.npz: positions must be (frames, joints, 3) in metres",
    'md.load("waker")': "CheckpointError: no weights are called 'waker'; there are: ",
    'md.load("mine.safetensors")': "CheckpointError: ",
    "md.Motion(np.zeros((4, 63)))": "MotionError: positions must be (frames, joints, 3) in metres",
    'md.Motion("walk.bvh")': "MotionError: positions must be numbers",
    "md.Motion(w.positions, root=w.root[:3])": "root has shape (3, 3); it must be (30, 3)",
    "md.Motion(w.positions, contacts=np.zeros((30, 3)))": "has shape (30, 3); it must be (30, 2)",
    "w[3]": "TypeError: cut a motion with motion[first:last], not [3]",
    'w.save("w.docx")': "w.docx: unknown ending .docx; use one of .bvh .npz .mp4 .gif .html",
    'walker().walk("w.bvh", ahead)': "TypeError: this takes a Motion, not str; md.read_motion",
    "walker().walk(w[:9], ahead)": "has 9 frames; the walker needs at least 10 (0.5 s)",
    "walker().walk(w, ahead, seconds=-3)": "ValueError: seconds must be above 0",
    "walker().walk(w, [(3, 1.2, 0, 0)])": "ValueError: a control is (rows, 3)",
    "walker().walk(w, np.full((9, 3), np.nan))": "row 0 of the control is [nan nan nan]",
    "walker().walk(w, np.full((9, 3), 1e30))": "row 0 of the control is [1.e+30 1.e+30 1.e+30]",
    "walker().walk(w, ahead, seed='a')": "seed must be a whole number from 0 to 2^63 - 1, not 'a'",
    "walker().walk(huge, ahead)": "the bones are 100 times as long as the course's",
    "md.inbetween(huge, known)": "Centimetres? Then pass 0.01 * positions",
    "md.reconstruct(huge, known)": "the bones are 100 times as long",
    "w.then(3)": "TypeError: this takes a Motion, not int",
    "w.all_but(13)": "TypeError: name the joints, such as 'LeftArm'",
    'md.keyframes("walk.bvh")': "TypeError: this takes a Motion, not str",
    'md.read_motion("flat.npz", file_fps=30)': "`file_fps` is for .bvh, not for .npz",
    "w.resampled(1e6)": "above 0 and at most 10,000",
    "walker().walk(nan, ahead)": "Head in frame 5 has no position",
    "walker().walk(stick, ahead)": "has 2 joints; the course's networks know the 21",
    "walker().walk(w, ahead, samples=0)": "samples must be a whole number of at least 1, not 0",
    'dancer().dance("nope.ogg")': "AudioError: nope.ogg does not exist; check the spelling",
    "dancer().dance(np.zeros(32000), seconds=-3)": "seconds must be above 0",
    "dancer().dance(np.ones(32000))": "samples do not say how fast they are played: pass",
    "dancer().dance([0.1] * 32000)": "samples do not say how fast they are played: pass",
    "dancer().dance(np.ones(9), sample_rate='9')": "from 1000 to 768000 Hz, not '9'",
    "dancer().dance(__import__('io').StringIO())": 'open it with open(path, "rb")',
    "dancer().dance(np.zeros(32000), sample_rate=16000)": "the samples are silent from start",
    "dancer().dance(np.ones(32000, np.int16), sample_rate=9999)": "not int16; divide 16-bit",
    "dancer().dance(np.full(32000, np.nan), sample_rate=16000)": "32000 samples are NaN",
    "dancer().dance(np.r_[np.zeros(99), 1e34], sample_rate=16000)": "the one at 0.006 s is 1e+34",
    "dancer().dance(w)": "sound must be the name of a file, its bytes, or samples with their "
    "sample_rate, not Motion",
    "md.keyframes(w, every=0)": "every must be a whole number of at least 1, not 0",
    "md.inbetween(w, known[:3])": "known is bool (3, 21); it must be bool (30, 21)",
    "md.inbetween(w, known[..., None])": "known is bool (30, 21, 1); it must be bool (30, 21)",
    "md.inbetween(w, known.astype(int))": "known is int64 (30, 21); it must be bool (30, 21)",
    "md.inbetween(nan, known | True)": "Head in frame 5 is given but has no position",
    'md.inbetween(w, w.all_but("Hips"))': "without the pelvis (Hips); give the pelvis too",
    "md.inbetween(w, w.known)": "every joint is known, so there is nothing to generate",
    "md.inbetween(w.resampled(60), known)": "60 frames/s, but the networks need 20",
    "md.reconstruct(w, w.known)": "nothing is missing",
    'md.reconstruct(w, w.all_but("Hips", 7, 9))': "pelvis (Hips) is not known in frame 7",
    "md.reconstruct(w[:9], known[:9])": "has 9 frames; the walker's windows have 10",
    "md.reconstruct(w, known[:, :5])": "known is bool (30, 5); it must be bool (30, 21)",
    "md.joystick([(3, 1.2)])": "numbers, (seconds, forward, left, turning), not (3, 1.2)",
    "md.joystick([(0.01, 1, 0, 0)])": "last less than a frame (0.05 s), all together",
    'walker().walk(w, "3s 1.2")': "a control is an array, not the text '3s 1.2'; joystick([",
    'md.load("waler")': "Did you mean 'walker'?",
    'w.all_but("LeftArm,LeftHand")': "Pass several joints as a list",
    'w.all_but("LeftArms")': "Did you mean 'LeftArm'?",
    "md.joystick((3, 1.2, 0, 0))": "joystick takes a list of segments",
    "md.inbetween(w, known, samples=10**6)": "samples must be at most 256, not 1000000",
    'md.reconstruct(w, ["LeftArm"])': "known is a table of True and False, not ['LeftArm']. motion",
    'md.inbetween(w, "lower body")': "editing.masks.body_part(len(motion), 'lower body') keeps",
    "md.joystick(None)": "joystick takes a list of segments",
    "md.joystick([(1e9, 1, 0, 0)])": "the segments last 1e+09 s; 3600 s is the most",
    'w.between("a", 1)': "times are numbers of seconds, not 'a' and 1",
    "w.all_but('Head', 3.5, 9)": "frames are whole numbers, not 3.5 and 9",
    "md.Motion(w.positions, audio=np.zeros(9))": "audio needs its sample_rate in Hz",
    "md.Motion(w.positions, audio='abc', sample_rate=9)": "audio must be numbers (N,)",
    "md.Motion(w.positions, root='abc')": "root must be numbers (30, 3)",
    "md.Motion(w.positions + 1j)": "positions must be numbers (frames, joints, 3)",
    "md.Motion(w.positions, root=w.root + 1j)": "root must be numbers (30, 3)",
    "md.Motion(w.positions, sample_rate=2.7)": "sample_rate must be a whole number of hertz, not",
    "md.joystick([('3', 1.2, 0, 0)])": "turning), not ('3', 1.2, 0, 0)",
    "md.joystick([(3, 1.2, 0, 0)], fps=0)": "fps must be a number of frames a second above 0",
    "md.joystick([(-3, 1.2, 0, 0)])": "a segment lasts 0 seconds or more, not -3",
    "md.joystick([(3, 1.2, 0, 0)], ramp=-1)": "ramp must be a number of seconds, 0 or more, not -1",
    "md.joystick([(3, 1.2, 0, 0)], ramp='a')": "ramp must be a number of seconds, 0 or more, not",
    "md.read_motion(None)": "a file is named by a text or a Path, not by None",
    "w.save(None)": "a file is named by a text or a Path, not by None",
    "md.load('walker', clip='x')": "the shipped 'walker' does not read by CLIP",
    "md.play()": "TypeError: play needs at least one motion",
    'md.play("walk.bvh")': "TypeError: this takes a Motion, not str",
    "md.play(nan, open_page=False)": "Head in frame 5 has no position",
    "md.play(w, stick, open_page=False)": "have different skeletons",
    "md.play(w, path='w.txt')": "its name ends in .html",
    "md.play(w, w, labels=['a'], open_page=False)": "1 labels for 2 motions",
}


@pytest.fixture(scope="module")
def answers(tmp_path_factory) -> dict[str, str]:
    return outcomes({code: code for code in TOLD}, tmp_path_factory.mktemp("typed"), SETUP)


@pytest.mark.parametrize("code", TOLD)
def test_what_cannot_be_is_answered_in_words(code, answers):
    assert TOLD[code] in answers[code] and "Traceback" not in answers[code]


def test_a_recording_is_continued_filled_in_and_mended(real_data, tmp_path, monkeypatch, capsys):
    """The README's promise, on files of strangers; the walk is somebody's, not ours."""
    monkeypatch.chdir(tmp_path)
    walk = md.read_motion(real_data / "bvh" / "cmu_12_01_walk_pybvh.bvh")
    more = md.load("walker").walk(walk, md.joystick([(1.5, 1.0, 0, 0)]), seed=0)
    more.save("more.bvh")
    assert len(md.read_motion("more.bvh")) == 30
    known = walk.all_but(ARM, 30, 60)
    whole = md.reconstruct(walk, known)
    lines = error_cm(straight_lines(walk, known), walk, known)
    assert error_cm(whole.positions, walk, known) < 0.8 * lines
    made = md.inbetween(walk, md.keyframes(walk, every=20), steps=20)
    made.save("made.npz")
    assert np.abs(made.positions).max() < 20  # metres: it does not fly off


@pytest.mark.parametrize("song", ["vibe_ace.ogg", "trumpet_90bpm_44k_stereo.ogg"])
def test_a_recorded_song_is_danced_to_in_one_line(song, real_data):
    made = md.load("dancer").dance(real_data / "audio" / song, seconds=2, seed=0)
    assert len(made) == 40 and len(made.audio) == 32_000 and made.known.all()
    assert 0.5 < made.positions[:, HIPS, 1].mean() < 1.2
