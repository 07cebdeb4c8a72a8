"""A dancer that dances the data's own dances has the data's measures, in every part."""

from pathlib import Path

import numpy as np
import pytest
import torch

from motiondiff_edu.motion.skeleton import BONE_LENGTHS
from tools.results.dances import parts, songs
from tools.results.dances.parts import DanceSize, Stage

SIZE = DanceSize(songs=3, seeds=1, pieces=2, each=2, taught=15)


class Perfect:
    """It knows the songs by their Mel frames; asked twice for one, it has another dance."""

    bones = BONE_LENGTHS

    def __init__(self):
        self.known: list[songs.Songs] = []
        self.frames: list[int] = []

    def dance_mel(self, mel, frames, *, generator=None, guidance=None, steps=None):
        self.frames.append(frames)
        made, asked = [], {}
        for one in mel:
            found, k = next(
                (found, k)
                for found in self.known
                for k, own in enumerate(found.mel)
                if torch.equal(own, one)
            )
            draw = asked[id(found), k] = asked.get((id(found), k), -1) + 1
            made.append(torch.from_numpy(found.truth[k, draw, :frames]))
        return torch.stack(made)


@pytest.fixture
def stage(monkeypatch):
    """Songs as they are composed, not as recordings; and weights of a perfect dancer."""
    perfect = Perfect()

    def kept(function):
        def made(*args, **kwargs):
            perfect.known.append(function(*args, **kwargs))
            return perfect.known[-1]

        return made

    for name in ("judged_songs", "danced_by_the_data"):
        monkeypatch.setattr(parts, name, kept(getattr(parts, name)))
    for module in (parts, songs):
        monkeypatch.setattr(module, "recorded_song", lambda song, seed: song)
    monkeypatch.setattr(parts, "weights_digest", lambda path: "w")
    stage = Stage(SIZE)
    stage.weights = {"dancer": Path("dancer")}
    stage.dancer = lambda name: perfect
    return stage


def values(records: list[dict]) -> dict[str, float]:
    return {one["name"]: one["value"] for one in records}


def test_a_perfect_dancer(stage):
    found = values(parts.dance_records(stage, "dancer", "c"))
    ratios = [
        "bas_share", "speed_over_data", "beats_per_beat_over_data", "multimodality_over_data",
        "standing_feet_over_data", "turning_over_data", "travel_over_data",
        "genre_accuracy_over_data", "long200_over_100", "long400_over_100",
    ]  # fmt: skip
    for name in ratios:
        assert found[f"dancer.{name}"] == pytest.approx(1, abs=1e-3), name
    # finishing a dance without faults changes next to nothing
    assert found["dancer.finished.bas_share"] == pytest.approx(1, abs=0.05)
    assert found["dancer.finished.bone_rmse_cm"] < 0.01
    assert found["dancer.repeat"] == pytest.approx(found["dancer.repeat_data"])
    data = values(parts.data_records(stage, "c"))
    truth = stage.songs.truth[:, 0]
    assert truth.shape == (3, 400, 21, 3)
    assert found["dancer.travel_mps"] == pytest.approx(
        np.mean([parts.floor_rows(truth)["travel_mps"]]), rel=1e-3
    )
    assert data["dance_data.standing_feet"] > 0
    assert set(stage.dancer("dancer").frames) == {100, 200, 400}


def test_a_perfect_dancer_to_music_unheard(stage):
    found = values(parts.dance_records(stage, "unheard", "c"))
    assert found["dancer.unheard_tempo_worst_share"] == pytest.approx(1, abs=1e-3)
    names = {name.split(".")[2] for name in found if name.startswith("dancer.unheard.")}
    assert names == {"metre5", "mallets", "tempo66-74", "tempo146-154"}
    for name in names:
        assert found[f"dancer.unheard.{name}.bas_share"] == pytest.approx(1, abs=1e-3)
    heard = {round(song.tempo) for made in stage.dancer("").known for song in made.songs}
    assert all(any(low <= tempo <= high for tempo in heard) for low, high in ((66, 74), (146, 154)))


def test_a_perfect_dancer_in_every_way(stage):
    found = values(parts.way_records(stage, "c"))
    for way in parts.WAYS:
        assert found[f"dancer.{way}.bas_share"] == pytest.approx(1, abs=1e-3)
