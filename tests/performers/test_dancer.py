"""A dancer: lengths, seeds, samplers, the baselines that dance, and its file."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from devices import devices_of
from seeds import seeded
from synthetic_dance import windows
from torch import nn

from motiondiff_edu import ddpm
from motiondiff_edu.baselines.transformer import (
    DanceTransformer,
    TransformerConfig,
    regression_loss,
)
from motiondiff_edu.ddpm import cosine_schedule
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.motion.dance_frame import to_positions
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.dancer import ETA, LOUD, Dancer
from motiondiff_edu.prediction import to_eps
from motiondiff_edu.pretrained.checkpoints import load, save

UNET = MoFusionConfig(C=5, S=12, widths=(16, 24), heads=2, music_layers=1, target="x0", skip=False)
PLAIN = TransformerConfig(C=5, S=12, width=16, heads=2, layers=2, music_layers=1)


def dancer(config=UNET) -> Dancer:
    torch.manual_seed(0)
    model = (MoFusion if isinstance(config, MoFusionConfig) else DanceTransformer)(config)
    with torch.no_grad():
        for weight in model.parameters():
            weight.add_(0.1 * torch.randn(weight.shape))
    motion = Scaler(torch.zeros(63), torch.full((63,), 0.1))
    mel = Scaler(torch.zeros(5), torch.ones(5))
    return Dancer(model.eval(), cosine_schedule(12), motion, mel, {"name": "test"})


def mel(B: int = 2, M: int = 64) -> torch.Tensor:
    return torch.randn(B, M, 5, generator=torch.Generator().manual_seed(5))


@pytest.mark.parametrize("steps", [4, None])
@pytest.mark.parametrize("config", [UNET, PLAIN])
def test_dances_are_as_long_as_asked_and_come_from_the_seed(config, steps):
    one = dancer(config)
    out = one.dance_mel(mel(), 30, generator=seeded(), steps=steps)
    assert out.shape == (2, 30, 21, 3) and torch.isfinite(out).all()
    assert torch.equal(out, one.dance_mel(mel(), 30, generator=seeded(), steps=steps))
    out[..., 1] += 0.0  # what is given can be changed in place
    assert not torch.equal(out, one.dance_mel(mel(), 30, generator=seeded(1), steps=steps))
    assert (
        one.dance_mel(mel(), generator=seeded(), steps=2).shape[1] == 41
    )  # 63 steps of 32 ms are 2.016 s: frames 0 to 40
    with pytest.raises(ValueError, match="lasts 41 frames"):
        one.dance_mel(mel(), 42)


def test_a_schedule_with_fewer_steps_than_the_usual_sampler_takes_is_danced_with_all_of_them():
    one = dancer()
    usual = one.dance_mel(mel(), 30, generator=seeded())
    assert torch.equal(usual, one.dance_mel(mel(), 30, generator=seeded(), steps=12))
    assert not torch.equal(usual, one.dance_mel(mel(), 30, generator=seeded(), steps=11))
    with pytest.raises(ValueError, match="between 1 and 12"):
        one.dance_mel(mel(), 30, steps=0)


def test_a_network_with_dropout_dances_without_it_and_stays_in_training():
    one = dancer()
    x_s, s = torch.randn(2, 30, 63, generator=seeded()), torch.full((2,), 5)
    one.model.out = nn.Sequential(nn.Dropout(0.5), one.model.out).eval()
    wanted = one.denoiser(mel(), 30)(x_s, s)
    one.model.train()
    torch.testing.assert_close(one.denoiser(mel(), 30)(x_s, s), wanted)
    assert one.model.training and one.model.out[0].training


@pytest.mark.parametrize("steps", [6, None])
def test_an_eps_network_does_not_tear_the_figure_apart(steps):
    """At s = S an error of eps is blown up by b / a; the guess is held within what dances are: no
    further than 0.5 m from a mean of 0, where the standard deviation is 0.1 m."""
    wild = dancer(replace(UNET, target="eps"))
    dance = wild.dance_mel(mel(), 30, generator=seeded(), steps=steps, eta=0.0)
    about = torch.cat([dance[:, :, :1], dance[:, :, 1:] - dance[:, :, :1]], dim=2)
    assert 0.49 < about.abs().max() < 0.501  # held, and by nothing closer


@pytest.mark.parametrize("steps", [5, None])
def test_a_dance_is_the_sampler_on_the_plain_network_in_its_own_units(steps):
    """DDIM with half of DDPM's noise, or DDPM with the posterior's; both scalers are felt."""
    one = dancer()
    motion = Scaler(0.2 * torch.randn(63, generator=seeded(1)), torch.full((63,), 0.1))
    heard = Scaler(torch.full((5,), -3.0), torch.full((5,), 4.0))
    one = replace(one, motion_scaler=motion, mel_scaler=heard)
    log_mel = 4 * mel() - 3
    made = one.dance_mel(log_mel, 30, generator=seeded(7), steps=steps)
    random = seeded(7)
    x_S = torch.randn(2, 30, 63, generator=random)
    music = one.model.listen(mel()[:, :47], torch.arange(47) * 512 / 16_000)  # 1.45 s of music

    @torch.no_grad()
    def denoise(x_s, s):
        return to_eps(one.model(x_s, s, music), x_s, s, one.schedule, "x0")

    if steps is None:
        loop = ddpm.sample_steps(denoise, x_S, one.schedule, generator=random, variance="posterior")
    else:
        loop = ddpm.ddim_steps(denoise, x_S, one.schedule, steps, ETA, generator=random)
    *_, last = loop
    wanted = to_positions(motion.mean + motion.std * last.x_s)
    torch.testing.assert_close(made, wanted, atol=2e-4, rtol=1e-3)


def test_the_same_noise_and_other_music_give_another_dance():
    one, start = dancer(), torch.randn(2, 30, 63)
    out = one.dance_mel(mel(), start=start, frames=30, steps=3, eta=0.0)
    assert torch.equal(out, one.dance_mel(mel(), start=start, frames=30, steps=3, eta=0.0))
    assert not torch.equal(
        out, one.dance_mel(mel().flip(1), start=start, frames=30, steps=3, eta=0.0)
    )


def test_only_music_that_sounds_meanwhile_is_heard():
    one, start = dancer(), torch.randn(2, 20, 63)
    longer = torch.cat([mel(), 9 + mel()], dim=1)
    both = [one.dance_mel(m, start=start, frames=20, steps=2, eta=0.0) for m in (mel(), longer)]
    assert torch.equal(*both)


@torch.no_grad()
def test_songs_of_several_lengths_in_one_batch_do_not_influence_one_another():
    model = dancer(PLAIN).model
    x = torch.randn(2, 30, 63)
    s = torch.tensor([3, 9])
    heard = torch.arange(64) < torch.tensor([64, 41])[:, None]
    times = torch.arange(64) / 31.25
    together = model(x, s, model.listen(mel(), times, heard))
    alone = model(x[1:], s[1:], model.listen(mel()[1:, :41], times[:41]))
    torch.testing.assert_close(together[1:], alone, atol=2e-5, rtol=1e-4)


def test_sizes_of_the_transformer_are_checked():
    for wrong in (
        {"width": 0},
        {"width": 18},
        {"heads": 0},
        {"target": "y"},
        {"fps": 0.0},
        {"slowest": 0.0},
    ):
        with pytest.raises(ValueError):
            replace(PLAIN, **wrong)


def test_regression_has_one_dance_for_a_song():
    one = dancer(replace(PLAIN, deterministic=True))
    out = one.dance_mel(mel(), 30, generator=seeded(0))
    assert torch.equal(out, one.dance_mel(mel(), 30, generator=seeded(1)))
    assert not torch.equal(out[0], out[1])


def test_regression_learns_the_mean_of_what_it_sees():
    """The mean pose is all that dances teach which have nothing to do with their music."""
    made = windows()
    model = DanceTransformer(replace(PLAIN, deterministic=True))
    draw = seeded()

    def loss_fn(model, generator):
        x0, music, _ = made.draw(16, generator)
        return regression_loss(model, x0, music, made.mel_times)

    optimizer = torch.optim.Adam(model.parameters(), lr=3e-3)
    first = loss_fn(model, draw).item()
    for _ in range(60):
        optimizer.zero_grad()
        loss_fn(model, draw).backward()
        optimizer.step()
    assert loss_fn(model, draw).item() < 0.9 * first


@pytest.mark.parametrize("config", [UNET, PLAIN])
def test_a_file_gives_the_same_dancer_back(config, tmp_path: Path):
    one = dancer(config)
    again = load(save(one, tmp_path / "one.safetensors", bits=32))
    assert again.config == config and again.card == {"name": "test"}
    assert isinstance(load(tmp_path / "one.safetensors"), Dancer)
    start = torch.randn(2, 20, 63)
    both = [d.dance_mel(mel(), start=start, frames=20, steps=3, eta=0.0) for d in (one, again)]
    torch.testing.assert_close(*both, atol=1e-6, rtol=1e-6)


def test_schedule_and_network_must_have_as_many_steps():
    one = dancer()
    with pytest.raises(ValueError, match="20 steps, the network 12"):
        Dancer(one.model, cosine_schedule(20), one.motion_scaler, one.mel_scaler)


def test_dancing_to_sound(tmp_path: Path):
    """From samples or from a file, the same; `seconds` cuts the sound, and the dance with it."""
    import soundfile

    one = dancer(replace(UNET, C=80))
    one = Dancer(
        one.model, one.schedule, one.motion_scaler, Scaler(torch.zeros(80), torch.ones(80))
    )
    sound = 0.3 * torch.randn(2 * 16_000, generator=seeded())
    out = one.dance(sound, sample_rate=16_000, steps=2)
    assert out.positions.shape == (40, 21, 3) and out.fps == 20 and out.sample_rate == 16_000
    assert np.array_equal(out.audio, sound.numpy())
    again, other = (
        one.dance(sound, sample_rate=16_000, seed=0, steps=2),
        one.dance(sound, sample_rate=16_000, seed=1, steps=2),
    )
    assert (out.positions == again.positions).all() and not (out.positions == other.positions).all()
    cut = one.dance(sound, sample_rate=16_000, seconds=1.5, steps=2)
    assert len(cut) == 30 and len(cut.audio) == 24_000
    with pytest.warns(UserWarning, match="lasts 2.0 s, and the dance ends with it"):
        assert len(one.dance(sound, sample_rate=16_000, seconds=99, steps=2)) == 40
    first, second = one.dance(sound, sample_rate=16_000, samples=2, steps=2)
    assert len(first) == len(second) == 40 and not (first.positions == second.positions).all()
    soundfile.write(tmp_path / "noise.wav", sound.numpy(), 16_000, subtype="FLOAT")
    read = one.dance(tmp_path / "noise.wav", steps=2)
    assert len(read) == 40 and read.source == "dance to noise"
    assert abs(read.audio - (sound - sound.mean()).numpy()).max() < 1e-3
    with pytest.raises(ValueError, match="spelling"):
        one.dance(tmp_path / "nothing.wav")


def test_a_sound_lasts_as_long_at_any_rate_and_from_any_source(tmp_path: Path):
    """A tone of 2 s as samples at three rates, as bytes, and as an open file: 40 frames each."""
    import soundfile

    one = replace(dancer(replace(UNET, C=80)), mel_scaler=Scaler.nothing(80))

    def tone(rate: int) -> np.ndarray:
        return 0.5 * np.sin(2 * np.pi * 440 * np.arange(2 * rate) / rate)

    path = tmp_path / "tone.wav"
    soundfile.write(path, tone(22_050), 22_050, subtype="FLOAT")
    how = {"steps": 2, "progress": False}
    ours = one.dance(tone(16_000), sample_rate=16_000, **how)
    with path.open("rb") as file:
        others = [
            one.dance(tone(22_050), sample_rate=22_050, **how),
            one.dance(torch.from_numpy(tone(44_100)), sample_rate=44_100.0, **how),
            one.dance(path.read_bytes(), **how),
            one.dance(file, **how),
        ]
    for other in others:
        assert (len(other), other.sample_rate) == (40, 16_000)
        np.testing.assert_allclose(other.audio[800:-800], ours.audio[800:-800], atol=2e-3)


@pytest.mark.parametrize("steps", [4, None])
@pytest.mark.parametrize("guidance", [1, 3])
def test_the_bar_is_full_at_the_end_with_guidance_as_well(guidance, steps, monkeypatch):
    totals, moved = [], []

    def counting(what, total, shown):
        totals.append(total)
        return lambda loop: (moved.append(step.s) or step for step in loop)

    monkeypatch.setattr("motiondiff_edu.performers.dancer.bar", counting)
    one = dancer(replace(UNET, C=80))
    one = replace(one, mel_scaler=Scaler.nothing(80), card={"recipe": {"no_music": 0.1}})
    noise = 0.3 * torch.randn(16_000, generator=seeded())
    one.dance(noise, sample_rate=16_000, steps=steps, guidance=guidance)
    assert totals == [len(moved)] == [(steps or 12) + 1] and moved[-1] == 0


def test_a_very_quiet_song_is_danced_to_as_if_it_were_louder():
    song = 0.5 * torch.sin(torch.arange(16_000) / 20.0) * torch.linspace(0, 1, 16_000)
    song *= LOUD / song.abs().max()
    one = replace(dancer(replace(UNET, C=80)), mel_scaler=Scaler.nothing(80))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loud = one.dance(song, sample_rate=16_000, steps=2, progress=False)
    with pytest.warns(UserWarning, match="very quiet .its loudest sample is 0.002"):
        quiet = one.dance(song * 0.002 / LOUD, sample_rate=16_000, steps=2, progress=False)
    np.testing.assert_allclose(quiet.positions, loud.positions, atol=1e-3)
    np.testing.assert_allclose(quiet.audio, song * 0.002 / LOUD, atol=1e-9)  # its own sound


@pytest.mark.parametrize(
    "sound, options, told",
    [
        (np.zeros(16_000, np.int16), {}, "floating-point samples from -1 to 1, not int16"),
        (np.array([0.1] * 99 + [1e34]), {}, "the one at 0.006 s is 1e"),
        (np.array([0.1] * 50 + [np.nan] * 3), {}, "3 samples are NaN or infinite"),
        (np.zeros((16_000, 2)), {}, "one channel"),
        (np.zeros(0), {}, "one channel"),
        (np.full(7000, 0.1), {}, "0.438 s of sound are too short: at least 0.5 s are needed"),
        (np.zeros(16_000), {}, "silent from start to end"),
        (np.repeat([0.0, 0.1], 16_000), {"seconds": 0.9}, "given is silent in its first 0.9 s"),
        (np.full(16_000, 0.1), {"sample_rate": None}, "pass sample_rate, in Hz"),
        (np.full(16_000, 0.1), {"sample_rate": 22.05}, "from 1000 to 768000 Hz, not 22.05"),
        (np.full(16_000, 0.1), {"sample_rate": np.nan}, "from 1000 to 768000 Hz, not nan"),
        ("song.ogg", {}, "a sound file has its own sample rate: leave sample_rate out"),
        (b"RIFF", {}, "leave sample_rate out"),
        (np.zeros(16_000), {"seconds": -3}, "seconds must be above 0"),
        (np.zeros(16_000), {"seconds": np.nan}, "a number above 0"),
        (np.zeros(16_000), {"samples": 0}, "samples must be a whole number of at least 1, not 0"),
    ],
)
def test_sound_that_cannot_be_danced_to_is_refused_in_words(sound, options, told):
    one = dancer(replace(UNET, C=80))
    with pytest.raises(ValueError, match=told):
        one.dance(sound, **{"sample_rate": 16_000} | options)


def test_a_dancer_moved_is_a_copy_that_dances_alike():
    one = dancer()
    moved = one.to("cpu")
    assert moved.model is not one.model and moved.card == one.card
    both = [d.dance_mel(mel(), 30, generator=seeded(), steps=3) for d in (one, moved)]
    torch.testing.assert_close(*both)


def places(one: Dancer) -> set[str]:
    """The devices of all that a performer needs."""
    return devices_of(one.model, one.motion_scaler, one.mel_scaler)


@pytest.mark.parametrize("config", [UNET, PLAIN])
def test_all_of_a_dancer_is_moved_and_the_first_one_stays(config):
    one = dancer(config)
    assert places(one.to("meta")) == {"meta"}
    assert places(one) == {"cpu"}


@pytest.mark.parametrize("steps", [3, None])
def test_all_lies_where_the_dancer_is_and_noise_is_drawn_where_the_generator_is(steps):
    """With another default device, whatever is made without regard to the inputs lands beside
    them."""
    deterministic = replace(PLAIN, deterministic=True)
    for config in (UNET, PLAIN, replace(UNET, target="eps"), deterministic):
        one = dancer(config)
        here, draw = one.dance_mel(mel(), 30, generator=seeded(), steps=steps), seeded()
        heard = mel()
        with torch.device("meta"):
            there = one.dance_mel(heard, 30, generator=draw, steps=steps)
        torch.testing.assert_close(there, here)


def test_music_is_brought_to_where_the_dancer_is():
    one, brought = dancer(), []

    class Elsewhere(torch.Tensor):
        def to(self, *args, **kwargs):
            brought.append(args[0])
            return super().to(*args, **kwargs).as_subclass(torch.Tensor)

    one.mel_input(mel().as_subclass(Elsewhere), 20)
    assert brought == [one.device]
