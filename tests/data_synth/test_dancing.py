"""Synthetic dances: same seed, same bytes.

Feet that stay, bones and knees that hold, on any beat grid.
"""

from dataclasses import replace

import numpy as np
import pytest

from data_synth.dancing import dance, dances
from data_synth.dancing.choreography import choreograph, slots
from data_synth.dancing.curves import curve, felt_beats, least_jerk, springy, within_reach
from data_synth.dancing.moves import MANNERS
from data_synth.dancing.performance import DANCES_A_SEED
from data_synth.dancing.script import REST, TURNS_SIGN, Script
from data_synth.dancing.sheet import Counts, Sheet
from data_synth.music.score import beat_song
from data_synth.music.song import GENRES, SAMPLE_RATE
from data_synth.walking.own_measures import knee_angles
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.skeleton import BONE_LENGTHS, BONES, HEELS, MIRROR, TOES
from motiondiff_edu.recipes.dancer import DANCER

METRES = (3, 4, 5)
TEMPI = {"house": 128, "hiphop": 92, "pop": 117, "latin": 104, "waltz": 101}
EVERY_MOVE = [
    (g, f.__name__) for g, m in MANNERS.items() for f in dict.fromkeys((*m.moves, *m.calm))
]


@pytest.fixture(scope="module")
def danced():
    """One dance for every genre and metre, on a drifting grid, 21 s each."""
    pairs = [(g, m) for g in GENRES for m in METRES]
    songs = [beat_song(21.0, TEMPI[g], m, g, k, drift=0.08) for k, (g, m) in enumerate(pairs)]
    return [(song, dance(song, k)) for k, song in enumerate(songs)]


@pytest.fixture(scope="module")
def alone():
    """Each move by itself for 11 s."""
    songs = [beat_song(11.0, TEMPI[g], GENRES[g][2], g, k) for k, (g, _) in enumerate(EVERY_MOVE)]
    return [
        dance(song, k, only=name)
        for k, (song, (_, name)) in enumerate(zip(songs, EVERY_MOVE, strict=True))
    ]


def slip(d) -> float:
    still = d.contacts[1:] & d.contacts[:-1]
    return float(np.linalg.norm(np.diff(d.positions[:, TOES], axis=0), axis=-1)[still].max())


def test_a_silent_score_is_a_song():
    song = beat_song(23.0, 100.0, 3, "waltz", seed=4, drift=0.05)
    assert (
        song.seconds == pytest.approx(23.0)
        and len(song.audio) == 23 * SAMPLE_RATE
        and not song.audio.any()
    )
    steady = beat_song(19.0, 100.0)
    assert np.diff(steady.beats) == pytest.approx(0.6) and steady.tempo == pytest.approx(100.0)
    assert np.diff(song.beats).std() > 0.01 and song.beats.max() < 23.0
    assert (
        list(song.bar_position[:5]) == [0, 1, 2, 0, 1]
        and 0 < song.energy.min() < 0.35 < song.energy.max() <= 1
    )
    assert set(song.bar_position[1:][np.diff(song.phrase) > 0]) == {0}  # phrases begin with a bar
    for wrong in ({"genre": "polka"}, {"metre": 1}, {"drift": 0.5}):
        with pytest.raises(ValueError):
            beat_song(19.0, 100.0, **wrong)
    with pytest.raises(ValueError, match="no two beats"):
        beat_song(0.5, 100.0)


def test_same_seed_same_bytes_and_two_seeds_differ():
    song = beat_song(17.0, 112.0)
    first = dance(song, 7)
    again = dance(song, 7)
    other = dance(song, 8)
    assert first.positions.tobytes() == again.positions.tobytes() and first.moves == again.moves
    apart = first.positions - first.positions[:, :1] - (other.positions - other.positions[:, :1])
    assert (
        np.sqrt((apart**2).sum(-1)).mean() > 0.1
    )  # metres: another dance, not the same one with noise
    assert first.moves != other.moves


def test_size_and_start(danced):
    for song, d in danced:
        assert d.positions.shape == (int(song.seconds * 20), 21, 3) and d.contacts.shape == (
            len(d),
            2,
        )
        assert np.isfinite(d.positions).all() and d.fps == 20.0 and d.genre == song.genre
        assert np.abs(d.positions[0, 0, [0, 2]]).max() < 0.25
        across = d.positions[0, 1] - d.positions[0, 5]
        assert across[0] / np.linalg.norm(across) > 0.8  # its left is +x: it faces z


def test_bones_are_constant(danced, alone):
    for d in [d for _, d in danced] + alone:
        bones = np.array(BONES)
        lengths = np.linalg.norm(d.positions[:, bones[:, 1]] - d.positions[:, bones[:, 0]], axis=-1)
        assert np.abs(lengths - BONE_LENGTHS).max() < 1e-9


def test_planted_feet_stay_on_the_floor(danced, alone):
    for d in [d for _, d in danced] + alone:
        assert slip(d) < 1e-3 and d.contacts.mean() > 0.2
        toes = d.positions[:, TOES]
        assert np.abs(toes[d.contacts][:, 1]).max() < 1e-3 and d.positions[..., 1].min() > -5e-3


def test_contacts_are_true(danced):
    """A toe that lies still on the floor for three frames is planted.

    The first instants of a step are left out.
    """
    for _, d in danced:
        toes = d.positions[:, TOES]
        still = (np.linalg.norm(np.diff(toes, axis=0), axis=-1) < 1e-7) & (toes[1:, :, 1] < 1e-7)
        assert d.contacts[1:-1][still[:-1] & still[1:]].mean() > 0.999


def test_knees_bend_one_way_and_not_too_far(danced, alone):
    for (_, d), name in zip(
        [*danced, *((None, d) for d in alone)], [*range(len(danced)), *EVERY_MOVE], strict=True
    ):
        p, ankle = d.positions, np.array(HEELS)
        angle = knee_angles(p)
        assert 10 < angle.min() and angle.max() < 140, name
        hip = p[:, ankle - 2]
        knee = p[:, ankle - 1]
        foot = p[:, ankle]
        left = p[:, [1]] - p[:, [5]]
        ahead = np.cross(
            foot - hip, left
        )  # of a leg, in the plane at right angles to the hips' line
        assert ((knee - (hip + foot) / 2) * ahead).sum(-1).min() > 0, name


def test_no_joint_jumps(danced, alone):
    """Hands of real dancers reach 10 m/s; nothing else is faster than the hands."""
    for d in [d for _, d in danced] + alone:
        speed = np.linalg.norm(np.diff(d.positions, axis=0), axis=-1) * 20
        assert speed.max() < 12 and speed[:, :13].max() < 8


def test_the_weight_is_over_the_other_foot_when_a_foot_lifts(danced):
    """Hips seen from above, along the line between the feet.

    Past the middle, towards the foot that stays.
    """
    shares = []
    for _, d in danced:
        for side in (0, 1):
            ankle = d.positions[:, HEELS[side]]
            other = d.positions[:, HEELS[1 - side]]
            lifts = np.flatnonzero(
                d.contacts[:-1, side] & ~d.contacts[1:, side] & d.contacts[1:].any(1)
            )
            line = (other - ankle)[lifts][:, [0, 2]]
            wide = np.linalg.norm(line, axis=-1) > 0.15
            along = ((d.positions[lifts, 0] - ankle[lifts])[:, [0, 2]] * line).sum(-1) / (
                line**2
            ).sum(-1)
            shares += list(along[wide])
    shares = np.array(shares)
    assert len(shares) > 200 and np.median(shares) > 0.75 and (shares > 0.5).mean() > 0.9


def test_feet_and_arms_keep_clear(danced):
    """The lines of the two feet stay apart, and no forearm goes through the spine."""
    u = np.linspace(0, 1, 7)[None, :, None]

    def gap(p, a, b, c, d):
        first, second = (p[:, [x]] + u * (p[:, [y]] - p[:, [x]]) for x, y in ((a, b), (c, d)))
        return np.linalg.norm(first[:, :, None] - second[:, None], axis=-1).min((1, 2))

    feet = np.concatenate([gap(d.positions, 3, 4, 7, 8) for _, d in danced])
    arms = np.concatenate([gap(d.positions, a, a + 1, 9, 11) for _, d in danced for a in (14, 18)])
    assert (feet < 0.05).mean() < 0.01 and (arms < 0.08).mean() < 0.01 and arms.min() > 0.03


def test_moves_start_on_beats_and_cover_the_song(danced):
    for song, d in danced:
        starts = [start for start, _, _ in d.moves]
        assert starts[0] == 0 and starts == sorted(set(starts)) and starts[-1] < len(song.beats)
        assert np.isin(song.bar_position[starts], 0).all() and max(np.diff(starts)) <= 14
        known = {f.__name__ for f in (*MANNERS[d.genre].moves, *MANNERS[d.genre].calm)}
        assert {name for _, name, _ in d.moves} <= known


def test_every_genre_has_six_moves_and_uses_them():
    for genre, manner in MANNERS.items():
        names = {f.__name__ for f in manner.moves}
        assert len(names) >= 6
        danced = {
            name
            for k in range(8)
            for _, name, _ in dance(beat_song(22.0, TEMPI[genre], genre=genre), k).moves
        }
        assert len(names & danced) >= len(names) - 1
    assert all(f.__doc__ for m in MANNERS.values() for f in (*m.moves, *m.calm))


def test_moves_are_repeated_mirrored():
    moves = [m for k in range(6) for m in dance(beat_song(25.0, 110.0, seed=k), k).moves]
    again = [
        (a, b) for a, b in zip(moves[:-1], moves[1:], strict=True) if a[1] == b[1] and a[0] < b[0]
    ]
    assert len(again) > 0.2 * len(moves) and all(a[2] != b[2] for a, b in again)


def test_breaks_are_calmer():
    ratios = []
    for k, genre in enumerate(GENRES):
        song = beat_song(40.0, TEMPI[genre], GENRES[genre][2], genre, k)
        d = dance(song, k)
        speed = np.linalg.norm(np.diff(d.positions, axis=0), axis=-1).mean(-1)
        now = np.clip(
            np.searchsorted(song.beats, np.arange(len(speed)) / 20) - 1, 0, len(song.beats) - 1
        )
        calm = song.energy[now] < 0.35
        ratios.append(speed[calm].mean() / speed[~calm].mean())
    assert np.mean(ratios) < 0.85


def test_a_mirrored_sheet_is_the_mirror():
    """A move written mirrored is the move with left and right swapped.

    Its keys and steps are.
    """
    found = []
    for mirrored in (False, True):
        script = Script()
        for name, value in REST.items():
            script.keys[name].append((-2.0, value))
        sheet = Sheet(
            script, Counts(0.0, 4, 1.0, 4), mirrored, 1.0, 1.0, REST, np.random.default_rng(3)
        )
        sheet.step(0, 0, 0.31, 0.12, turn=20)
        sheet.arms(1, (40, 20, 10, 60), (5, 70, 0, 20))
        sheet.key("twist", (1, 15))
        sheet.go(2, x=0.4, turn=30)
        sheet.step(1, 3, -0.2, 0.1)
        script.enter(sheet.keys)
        found.append(script)
    plain, mirror = found
    for ours, theirs in zip(plain.steps, mirror.steps[::-1], strict=True):
        for a, b in zip(ours, theirs, strict=True):
            assert (a.x, a.z, a.yaw) == pytest.approx((-b.x, b.z, -b.yaw)) and a.lift == b.lift
    assert plain.home == pytest.approx((-mirror.home[0], mirror.home[1], -mirror.home[2]))
    for name in REST:
        swapped = {"l": "r", "r": "l"}[name[0]] + name[1:] if name[1] == "_" else name
        sign = -1 if name in TURNS_SIGN else 1
        assert np.array(plain.keys[name]) == pytest.approx(
            np.array(mirror.keys[swapped]) * [1, sign]
        )
    assert MIRROR[15] == 19  # the hands: what "swapped" means in the skeleton


def test_a_curve_is_still_at_its_keys():
    keys = [(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 4.0)]
    b = np.linspace(-0.5, 3.5, 4001)
    eased, flowing = curve(b, keys, 0.1, 0.0), curve(b, keys, 0.1, 1.0)
    for at, value in keys:
        assert eased[np.abs(b - at).argmin()] == pytest.approx(value, abs=1e-6)
        assert flowing[np.abs(b - at).argmin()] == pytest.approx(value, abs=1e-2)
        assert np.abs(np.gradient(eased, b)[np.abs(b - at) < 0.04]).max() < 1e-6
    assert least_jerk(np.array([0.25]))[0] == pytest.approx(10 / 64 - 15 / 256 + 6 / 1024)
    assert eased[0] == 1.0 and eased[-1] == 4.0


def test_a_spring_settles_and_overshoots():
    """A step of height one.

    9.5 % too far at damping 0.6 (exp(-pi d / sqrt(1 - d^2))), and then there.
    """
    step = np.concatenate([np.zeros(3), np.ones(60)])[:, None]
    y = springy(step, 200.0, 4.0, 0.6)
    assert y[0, 0] == 0 and y.max() == pytest.approx(1 + np.exp(-np.pi * 0.6 / 0.8), abs=2e-3)
    assert springy(np.full((40, 2), 3.0), 20.0, 4.0, 0.6) == pytest.approx(3.0)


def test_keys_out_of_reach_are_brought_in():
    kept = within_reach([(0.0, 0.0), (1.0, 100.0), (2.0, 90.0)], np.array([0.0, 0.5, 1.0]), 150.0)
    assert kept == [(0.0, 0.0), (1.0, 75.0), (2.0, 90.0)]


def test_felt_beats_miss_by_as_much_as_told():
    beats = np.arange(400) * 0.5
    seconds, number = felt_beats(beats, np.random.default_rng(2), 0.018, -0.03)
    on = number % 1 == 0
    miss = seconds[on] - 0.5 * number[on]
    assert miss.mean() == pytest.approx(-0.03, abs=0.004) and miss.std() == pytest.approx(
        0.018, abs=0.003
    )
    assert (np.diff(seconds) > 0).all()


def test_slots_cover_the_song_in_whole_bars():
    for metre in METRES:
        song = beat_song(40.0, 120.0, metre)
        cuts = slots(song, np.random.default_rng(metre))
        assert sum(length for _, length in cuts) == len(song.beats)
        assert all(start % metre == 0 and 3 <= length <= 14 for start, length in cuts)


def test_wrong_inputs_are_told():
    song = beat_song(10.0, 100.0)
    with pytest.raises(ValueError, match="no move 'waltzing'; it has grapevine"):
        dance(song, 0, only="waltzing")
    with pytest.raises(ValueError, match="seed"):
        dance(song, -1)
    with pytest.raises(ValueError, match="no moves for the genre 'polka'"):
        dance(replace(song, genre="polka"), 0)
    one = {name: getattr(song, name)[:1] for name in ("beats", "bar_position", "phrase", "energy")}
    with pytest.raises(ValueError, match="two beats or more"):
        dance(replace(song, hits={}, **one), 0)


def test_a_very_short_song_and_one_that_starts_late():
    short = dance(beat_song(1.5, 80.0), 3)
    assert short.positions.shape == (30, 21, 3) and np.isfinite(short.positions).all()
    script, moves = choreograph(beat_song(1.5, 80.0), np.random.default_rng(0))
    assert len(moves) == 1 and script.keys["drop"]


def test_several_dances_to_each_song():
    made = list(dances(2, 3, 6.0, each=2))
    assert [song.seed for song, _ in made] == [3_000_000, 3_000_000, 3_000_001, 3_000_001]
    assert made[0][0] is made[1][0] and [d.seed for _, d in made] == [
        300_000,
        300_001,
        300_002,
        300_003,
    ]
    assert not np.array_equal(made[0][1].positions, made[1][1].positions)
    for n, each in ((2, 0), (50_001, 2)):
        with pytest.raises(ValueError, match="one dance to a song or more, 100000 in all"):
            dances(n, 3, 6.0, each=each)


def test_the_command_writes_several_dances_to_a_song(tmp_path):
    from data_synth.dancing.write import main

    main(["--out", str(tmp_path), "--dances", "3", "--each", "2", "--seconds", "4", "--seed", "1"])
    wanted = list(dances(2, 1, 4.0, each=2))[:3]
    assert len(list(tmp_path.glob("*.npz"))) == 3
    for k, (song, danced) in enumerate(wanted):
        with np.load(tmp_path / f"dance_{k:03d}.npz") as f:
            assert f["song_seed"] == song.seed and f["seed"] == danced.seed
            np.testing.assert_array_equal(f["positions"], danced.positions.astype(np.float32))


def test_the_cards_training_data_are_the_dancers(root):
    card = (root / "data_synth" / "README.md").read_text(encoding="utf-8")
    first = f"{DANCER.data_seed * DANCES_A_SEED:_}"
    songs = f"training_songs({DANCER.songs}, {DANCER.data_seed}, {DANCER.seconds:.1f})"
    said = f"`dances_to({songs}, {first}, {DANCER.dances})`"
    assert f"{DANCER.songs:,} songs of {DANCER.seconds:g} s" in card and said in card


def test_the_command_writes_files(tmp_path, capsys):
    from data_synth.dancing.write import main

    main(
        ["--out", str(tmp_path), "--dances", "2", "--seconds", "6", "--genre", "pop", "--seed", "3"]
    )
    assert "2 dances of 6 s (pop)" in capsys.readouterr().out
    with np.load(tmp_path / "dance_001.npz") as f:
        assert f["positions"].shape == (120, 21, 3) and f["contacts"].shape == (120, 2)
        assert (
            len(f["beats"]) == len(f["bar_position"])
            and str(f["genre"]) == "pop"
            and f["move_starts"][0] == 0
        )
        _, (song, danced) = dances(2, 3, 6.0, genre="pop")
        assert f["song_seed"] == song.seed == 3_000_001 and f["seed"] == danced.seed == 300_001
        np.testing.assert_array_equal(f["positions"], danced.positions.astype(np.float32))
    assert len(read_bvh(tmp_path / "dance_000.bvh").frames) == 120
    with pytest.raises(SystemExit):
        main(["--out", str(tmp_path), "--dances", "0"])
