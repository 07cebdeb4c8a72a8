"""What teaches an ear: batches that are the songs', and a loss that is worked by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
import torch

from data_synth.music.varied import varied_song
from motiondiff_edu.beyond import hearing
from motiondiff_edu.conditions.music import log_mel
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.ear import Ear, EarConfig, EarOutput, rescale_ear
from motiondiff_edu.recipes import ear as recipes
from motiondiff_edu.recipes.ear import EarRecipe, drawn_batch, hearing_loss, loss_of_ear, train_ear
from motiondiff_edu.recipes.songs import HeardSongs, songs_as_mel, training_songs, without_sound

RECIPE = EarRecipe(
    config=EarConfig(C=3, width=16, blocks=1), frames=(21,), batch=40, gain_noise=0.0, steps=2
)
PLAIN = hearing.MelAugmentation((1.33, 0.0), 0.0, (0.0, 0.0), (0, 0.0))
FRAMES = 80


@pytest.fixture
def songs() -> HeardSongs:
    """Songs whose Mel frames tell song and frame, and whose counts differ in both columns."""
    at = torch.arange(float(FRAMES))
    mel = torch.stack([torch.stack([at, at * 0 + k, -at], -1) for k in range(6)])
    counts = torch.stack([torch.stack([(0.1 + 0.01 * k) * at, 0.03 * at], -1) for k in range(6)])
    tempi = torch.tensor([100.0, 110, 120, 130, 100, 110])
    return HeardSongs(mel, counts, tempi, torch.arange(6) % 5, Scaler.nothing(3))


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_a_batch_is_made_of_the_songs_own_frames_counts_and_genres(songs, monkeypatch):
    monkeypatch.setattr(recipes, "MelAugmentation", lambda: PLAIN)
    mel, counts, genres = drawn_batch(RECIPE, songs, seeded())
    frame, song = mel[..., 0], mel[..., 1].round().long()
    torch.testing.assert_close(frame.diff(dim=1), torch.ones(40, 20), atol=1e-4, rtol=0)
    assert (song == song[:, :1]).all() and len(song.unique()) > 3
    assert torch.equal(genres, songs.genres[song[:, 0]])
    torch.testing.assert_close(counts[..., 0], (0.1 + 0.01 * song) * frame, atol=1e-4, rtol=0)
    torch.testing.assert_close(counts[..., 1], 0.03 * frame, atol=1e-4, rtol=0)
    assert frame.min() < 5 and frame.max() > FRAMES - 6, "from everywhere in the song"


def test_a_song_played_faster_is_counted_faster(songs, monkeypatch):
    monkeypatch.setattr(recipes, "MelAugmentation", lambda: replace(PLAIN, faster=(1.33, 1.0)))
    mel, counts, _ = drawn_batch(replace(RECIPE, frames=(71,)), songs, seeded())
    speed = mel[..., 0].diff(dim=1)
    assert speed.std() > 0.05 and speed.max() <= (FRAMES - 1) / 70 + 1e-3, "the song is too short"
    torch.testing.assert_close(counts[..., 1].diff(dim=1), 0.03 * speed, atol=1e-4, rtol=0)
    assert mel[..., 0].max() <= FRAMES - 1


def test_the_loss_by_hand():
    counts = torch.tensor([[[0.25, 0.5], [math.nan, math.nan]]])
    said = EarOutput(
        beat=torch.tensor([[[0.0, 0.5], [7.0, 7.0]]]),  # the beat is at (0, 1)
        bar=torch.tensor([[[-1.0, 2.0], [7.0, 7.0]]]),  # the bar is at (-1, 0)
        sounds=torch.tensor([[0.0, math.log(3)]]),
        genre=torch.tensor([[[1.0, 0, 0, 0, 0], [1.0, 2, 0, 0, 0]]]),
    )
    parts = {name: float(x) for name, x in hearing_loss(said, counts, torch.tensor([1])).items()}
    means = np.array([1.0, 1.0, 0, 0, 0])
    assert parts == pytest.approx(
        {
            "beat": 0.25,  # where there is none, nothing counts
            "bar": 4.0,
            "sounds": (math.log(2) + math.log(4)) / 2,
            "genre": math.log(np.exp(means).sum()) - 1,
        },
        abs=1e-6,
    )


def test_an_ear_is_asked_at_the_times_of_its_tokens(songs, monkeypatch):
    """An answer that is right at every second Mel frame has no loss for its places."""
    monkeypatch.setattr(recipes, "MelAugmentation", lambda: PLAIN)
    monkeypatch.setattr(recipes, "WEIGHTS", {"beat": 1, "bar": 1, "sounds": 0, "genre": 0})
    _, counts, _ = drawn_batch(RECIPE, songs, seeded(3))
    right = hearing.on_circles(counts[:, ::2])

    class Knows(torch.nn.Module):
        stride = 2

        def __init__(self):
            super().__init__()
            self.weight = torch.nn.Parameter(torch.zeros(1))

        def forward(self, mel, times):
            assert float(times[1]) == pytest.approx(512 / 16_000)
            return right

        def read(self, tokens):
            nothing = torch.zeros(40, 11, 5)
            return EarOutput(tokens[..., :2], tokens[..., 2:], nothing[..., 0], nothing)

    assert float(loss_of_ear(RECIPE, songs)(Knows(), seeded(3))) == pytest.approx(0, abs=1e-6)
    assert float(loss_of_ear(RECIPE, songs)(Knows(), seeded(4))) > 0.1


def test_heard_songs_are_their_scores():
    made = [without_sound(varied_song(seed, 12.0)) for seed in (3, 4)]
    songs = HeardSongs.of(made)
    for k, (song, mel) in enumerate(made):
        assert song.seconds == 12.0 and not song.audio.any()
        torch.testing.assert_close(songs.scaler.inverse(songs.mel[k]), mel, atol=1e-4, rtol=1e-4)
        assert songs.tempi[k] == pytest.approx(song.tempo)
        on = np.round(song.downbeats * 31.25).astype(int)  # the nearest frames
        on = on[(on > 0) & (on < len(mel))]
        bar = songs.counts[k, on, 1]
        bar = bar[~bar.isnan()]
        assert len(bar) > 1 and ((bar + 0.5) % 1 - 0.5).abs().max() < 0.05


def test_songs_as_mel_are_the_training_songs_and_are_kept():
    made = songs_as_mel(2, 1, 8.0)
    assert songs_as_mel(2, 1, 8.0) is made and made[1][1].shape == (251, 80)
    first, second = training_songs(2, 1, 8.0)
    wanted = log_mel(torch.from_numpy(second.audio).float(), 16_000)
    assert torch.equal(made[1][1], wanted) and made[1][0].seed == second.seed != first.seed


def test_an_ear_hears_the_same_by_another_scaler():
    torch.manual_seed(0)
    ear, other = (
        Ear(EarConfig(C=3, width=16, blocks=1)),
        Scaler(torch.arange(3.0), torch.ones(3) * 3),
    )
    own = Scaler(torch.tensor([1.0, -1, 0]), torch.tensor([0.5, 2, 1]))
    mel, times = torch.randn(1, 30, 3, generator=seeded()), torch.arange(30) / 31.25
    again = rescale_ear(ear, own, other)
    wanted = ear(own.transform(mel), times)
    torch.testing.assert_close(again(other.transform(mel), times), wanted, atol=1e-4, rtol=1e-4)
    assert (ear(other.transform(mel), times) - wanted).abs().max() > 0.1
    for a, b in zip(rescale_ear(ear, own, own).parameters(), ear.parameters(), strict=True):
        assert torch.equal(a, b)


def test_songs_that_are_too_short_are_refused(songs, tmp_path):
    with pytest.raises(ValueError, match="have 80 Mel frames; pieces of 90 need more"):
        train_ear(replace(RECIPE, frames=(20, 90)), tmp_path / "run.safetensors", songs)
