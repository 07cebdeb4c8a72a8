"""The player in Python: packing, traits, errors, and the pictures it writes."""

import re

import numpy as np
import pytest
import torch
import traitlets
from PIL import Image
from synthetic_walk import walk

from motiondiff_edu.motion.skeleton import JOINTS
from motiondiff_edu.widgets import packing, poster
from motiondiff_edu.widgets.player import Look, Player


@pytest.fixture(scope="module")
def motion():
    return walk(frames=37, turn=0.4)


def test_unpacked_positions_are_within_a_quarter_millimetre(motion):
    figures = [motion[0] + [30.0, 0, 40.0], walk(frames=11, speed=3.0)[0]]
    back = packing.unpack(packing.pack(figures))
    assert [len(b) for b in back] == [37, 11]
    for given, got in zip(figures, back, strict=True):
        assert np.abs(given - got).max() < 0.5 / 2048 + 1e-5


def test_a_late_word_of_the_page_about_a_longer_motion_is_no_error(motion):
    player = Player(motion[0])
    player.notes = ["of the longer motion"]
    player.show(motion[0][:20])
    assert player.notes == []
    player.set_state({"frame": 30, "playing": True})
    assert (player.frame, player.playing) == (19, True)
    player.set_state({"frame": -1})
    assert player.frame == 0
    with pytest.raises(traitlets.TraitError, match="frame 30 does not exist"):
        player.frame = 30  # in Python it is a mistake


def test_pages_are_laid_out_in_a_phones_width(motion):
    page = Player(motion[0]).page()
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in page


def test_a_walk_of_80_seconds_at_3_metres_a_second_fits():
    positions, _ = walk(frames=1600, speed=3.0)
    assert (
        np.abs(packing.unpack(packing.pack([positions]))[0] - positions).max() < 0.5 / 2048 + 2e-5
    )


def test_the_largest_reach_is_kept_and_one_unit_more_is_refused(motion):
    positions = motion[0].copy()
    positions[5, 12] = positions[5, 0] + [packing.REACH, 0, -packing.REACH]
    assert (
        np.abs(packing.unpack(packing.pack([positions]))[0] - positions).max() < 0.5 / 2048 + 1e-5
    )
    positions[5, 12, 0] += 2 / 2048
    with pytest.raises(
        ValueError, match=r"figure 0, frame 5, joint 12 \(Head\): more than 16 m .* cm\?"
    ):
        packing.pack([positions])


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_position_that_is_not_finite_is_named(motion, bad):
    positions = motion[0].copy()
    positions[7, 3, 1] = bad
    with pytest.raises(
        ValueError, match=r"figure 1, frame 7, joint 3 \(LeftFoot\): the position is not finite"
    ):
        Player([motion[0], positions])


@pytest.mark.parametrize(
    "positions, message",
    [
        (np.zeros((5, 63)), r"figure 0 has shape \(5, 63\)"),
        (np.zeros((5, 17, 3)), "17 joints, the course's skeleton has 21: give `parents`"),
        (np.zeros((0, 21, 3)), "figure 0 has no frames"),
        ([], "no figure given"),
        ([np.zeros((5, 21, 3)), np.zeros((5, 4, 3))], r"different numbers of joints: \[21, 4\]"),
        ("walk.bvh", "'walk.bvh' is a file's name: md.play"),
        (np.zeros((5, 21, 3), complex), "positions must be numbers in metres.*complex"),
        (["up", "down"], "positions must be numbers in metres, not str"),
        (np.full((5, 21, 3), 1e30), r"joint 0 \(Hips\): more than 10,000 m from the origin"),
    ],
)
def test_wrong_shapes_are_explained(positions, message):
    with pytest.raises(ValueError, match=message):
        Player(positions)


def test_wrong_extras_are_explained(motion):
    with pytest.raises(
        ValueError, match=r"contacts of figure 0 have shape \(36, 2\); they must be \(37, 2\)"
    ):
        Player(motion[0], contacts=motion[1][1:])
    with pytest.raises(ValueError, match="3 values of `labels` for 1 figures"):
        Player(motion[0], labels=["a", "b", "c"])
    with pytest.raises(ValueError, match="layout"):
        Player(motion[0], look=Look(layout="diagonal"))
    for fps in (0, -20.0, float("nan"), 1e9):
        with pytest.raises(ValueError, match="fps must be a number of frames a second above 0"):
            Player(motion[0], fps=fps)
    for past in (-3, 38):
        with pytest.raises(ValueError, match=f"past = {past}: .* from 0 to the 37"):
            Player(motion[0], past=past)
    with pytest.raises(ValueError, match=r"path must be .x, z. in metres, of shape \(n, 2\)"):
        Player(motion[0], path=np.full((4, 2), np.nan))
    with pytest.raises(TypeError, match="colour"):
        Player(motion[0]).show(motion[0], colour="red")
    with pytest.raises(TypeError, match="colour"):
        Player(motion[0], colour="red")


@pytest.mark.parametrize(
    "options, message",
    [
        ({"height": -5}, "height is 60 to 4000 pixels, not -5"),
        ({"offset": (float("nan"), 0.0)}, "offset is .x, z. in metres"),
        ({"parents": [-1, 50, *[0] * 19]}, r"parents\[1\] = 50: .* there are 21 joints"),
        ({"parents": [-1, -2, *[0] * 19]}, r"parents\[1\] = -2"),
        ({"parents": [-1, 2, 3, 1, *[0] * 17]}, "joint 1 leads to no root"),
        ({"parents": [-1, 0, 2, *[0] * 18]}, "joint 2 leads to no root"),
    ],
)
def test_a_look_that_cannot_be_drawn_is_explained(options, message):
    with pytest.raises(ValueError, match=message):
        Look(**options)


def test_batches_tensors_and_lists_are_the_same_figures(motion):
    batch = np.stack([motion[0], motion[0] + 0.25])
    players = [Player(batch), Player(torch.as_tensor(batch)), Player(list(batch))]
    assert len({p.joints for p in players}) == len({p.roots for p in players}) == 1
    assert [f["frames"] for f in players[0].scene["figures"]] == [37, 37]


def test_contacts_are_coded_left_one_right_two(motion):
    contacts = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], dtype=bool)
    assert packing.pack_contacts([contacts, None], [4, 2]) == bytes([0, 1, 2, 3, 0, 0])


def test_frame_can_be_set_and_a_frame_that_does_not_exist_is_refused(motion):
    player = Player(motion[0])
    player.frame = 36
    with pytest.raises(traitlets.TraitError, match="frame 37 does not exist; frames are 0 to 36"):
        player.frame = 37


def test_show_replaces_the_motion_and_keeps_the_frame_in_range(motion):
    player = Player(motion[0], past=10, labels=["first"])
    player.frame = 30
    player.show(walk(frames=9)[0], past=4)
    assert player.frame == 8
    assert player.scene["figures"] == [
        {"frames": 9, "label": "first", "past": 4, "contacts": False, "path": None}
    ]


def test_other_skeletons_are_drawn_with_their_parents():
    positions = np.random.default_rng(0).normal(size=(6, 4, 3))
    player = Player(positions, look=Look(parents=[-1, 0, 1, 1]))
    assert len(player.scene["parts"]) == 3 and player.scene["joints"] == 4
    with pytest.raises(ValueError, match="`parents` has 3 joints, but the positions 4"):
        Player(positions, look=Look(parents=[-1, 0, 1]))


def test_the_bundle_has_live_static_and_still_forms(motion):
    bundle, _ = Player(
        motion[0], contacts=motion[1], past=10, labels=['<"walker">']
    )._repr_mimebundle_()
    assert set(bundle) >= {
        "application/vnd.jupyter.widget-view+json",
        "text/html",
        "image/png",
        "text/plain",
    }
    words = r'<img alt="Moving skeletons[^"]+&lt;&quot;walker&quot;&gt;: 1.9 s[^"]*0.5 s given'
    assert re.search(words, bundle["text/html"])
    assert 'sandbox="allow-scripts"' in bundle["text/html"]
    assert not re.search(r'(src|href)="(https?:)?//', bundle["text/html"])
    assert len(bundle["text/html"]) < 160_000


def test_poster_shows_both_sides_and_washes_out_the_past(motion):
    def blue(past):
        pixels = np.asarray(Player(motion[0], past=past).poster()).astype(int)
        return int(((pixels[..., 2] > pixels[..., 0] + 110) & (pixels[..., 0] < 60)).sum())

    assert blue(None) > 2000
    assert blue(37) < blue(18) < blue(None)


def test_gif_and_mp4_have_every_frame(motion, tmp_path):
    player = Player(
        [motion[0][:9], motion[0][:7]], contacts=[motion[1][:9], None], labels=["a", "b"]
    )
    with Image.open(player.save_gif(tmp_path / "walk.gif", (90, 80))) as gif:
        assert (gif.size, gif.n_frames, gif.info["duration"]) == ((180, 80), 9, 50)
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg")
    path = player.save_mp4(tmp_path / "walk.mp4", (96, 64))
    assert imageio_ffmpeg.count_frames_and_secs(str(path))[0] == 9
    assert sorted(p.name for p in tmp_path.iterdir()) == ["walk.gif", "walk.mp4"]


@pytest.mark.parametrize("fps, pictures", [(20, 24), (30, 24), (60, 12), (120, 8)])
def test_a_gif_lasts_as_long_as_the_motion(motion, tmp_path, fps, pictures):
    """Its clock counts in hundredths of a second, and browsers slow down pictures under 20 ms."""
    player = Player(motion[0][:24], fps=fps)
    with Image.open(player.save_gif(tmp_path / "walk.gif", (90, 80))) as gif:
        pauses = []
        for frame in range(gif.n_frames):
            gif.seek(frame)
            pauses.append(gif.info["duration"])
    assert len(pauses) == pictures and min(pauses) >= 20
    assert sum(pauses) == pytest.approx(1000 * 24 / fps, abs=5)


@pytest.mark.parametrize("save", ["save_gif", "save_mp4"])
def test_a_place_that_cannot_be_written_is_told_before_a_picture_is_drawn(
    save, motion, tmp_path, monkeypatch
):
    (tmp_path / "walk.html").touch()
    monkeypatch.setattr(poster, "render", lambda *_, **__: pytest.fail("it draws"))
    player = Player(motion[0])
    with pytest.raises(OSError, match="walk.html is a file, not a folder; choose another place"):
        getattr(player, save)(tmp_path / "walk.html" / f"walk.{save[-3:]}")


def test_a_file_that_cannot_be_written_leaves_nothing_behind(motion, tmp_path):
    (tmp_path / "walk.html").mkdir()  # a folder has the name already
    with pytest.raises(OSError):
        Player(motion[0]).save_html(tmp_path / "walk.html")
    assert [path.name for path in tmp_path.iterdir()] == ["walk.html"]


def test_left_and_right_parts_follow_the_names_of_the_joints():
    from motiondiff_edu.viz.body import BODY

    for part in BODY:
        names = {JOINTS[j] for a, b, _, _ in part.circles for j in (a, b)}
        if part.side != "C":
            assert all(name.startswith({"L": "Left", "R": "Right"}[part.side]) for name in names)
