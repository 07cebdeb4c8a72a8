"""Checks of notebook 11: hearing."""

import numpy as np
import torch

from ._report import as_array, check, expect, expect_close


@check
def log_mel_from_spectrum(mine):
    """Check mine(X, filters, floor): 2 frames, 4 frequencies, 3 bands, worked out by hand.

    In the second test one frame is silent.
    """
    X = torch.tensor([[3 + 4j, 0, 2j, 1], [0, 1j, 0, -2]], dtype=torch.complex64)
    filters = torch.tensor([[1.0, 0.5, 0, 0], [0, 0.5, 1, 0], [0, 0, 0, 0.25]])
    power = torch.tensor([[25.0, 4.0, 0.25], [0.5, 0.5, 1.0]])
    silent = torch.stack([X[0], torch.zeros(4)])
    floor, wanted = 0.01, power.log()
    loud = torch.tensor([[5.0, 2.0, 0.25], [0.5, 0.5, 0.5]])  # the same with magnitudes
    mistakes = {
        "those are magnitudes; power is their square": loud.log(),
        ("the bands come first; here time comes first: return (M, bands)"): wanted.T,
        "that is the logarithm to base 10": power.log10(),
        "that is in decibels": 10 * power.log10(),
        "that is log(1 + power), in which soft sounds almost disappear": power.log1p(),
        "the logarithm is still missing": power,
        "the floor was added; it is a lower limit": (power + floor).log(),
    }
    answer = mine(X, filters, floor)
    expect_close(answer, wanted, "log-Mel", mistakes)
    answer = as_array(mine(silent, filters, floor))
    expect(
        not np.isneginf(answer).any(),
        "in silence it is minus infinity: limit the power to the floor before the logarithm",
    )
    quiet = torch.tensor([[25.0, 4.0, 0.25], [floor, floor, floor]]).log()
    mistakes = {
        "the floor limits the logarithm; it should limit the power": torch.stack(
            [wanted[0], torch.full((3,), floor)]
        )
    }
    expect_close(answer, quiet, "log-Mel of silence", mistakes)
    return "With a floor of 1e-5, silence is log(1e-5) = -11.5."


@check
def mel_index(mine):
    """mine(T): nearest in time; where two are equally near, either is right."""
    T = 1000
    index = as_array(mine(T))
    expect(
        index.shape == (T,),
        f"for {T} motion frames there should be {T} indices, got shape {index.shape}",
    )
    expect((index == np.round(index)).all(), "an index is a whole number: round it")
    motion = np.arange(T)
    late = index * 512 / 16_000 - motion / 20
    if (np.abs(late) <= 0.016 + 1e-6).all():
        return (
            f"At {motion[-1] / 20:.2f} s, motion is at frame {T - 1}, "
            f"sound at frame {int(index[-1])}."
        )
    for hint, wrong in {
        "that matches by index, frame t with frame t. Their frame rates differ": motion,
        "a second has 31.25 Mel frames, not 32: after 50 s that is 1.2 s off": np.round(
            motion * 32 / 20
        ),
        "the two frame rates are swapped": np.round(motion * 20 / 31.25),
        "that is the frame before, not the nearest one: round, do not truncate": np.floor(
            motion * 1.5625
        ),
        "that is the frame after, not the nearest one: round": np.ceil(motion * 1.5625),
        "the hop is 512 samples; the window, 1024, does not matter here": np.round(
            motion * 16_000 / 1024 / 20
        ),
    }.items():
        expect(not np.array_equal(index, wrong), hint)
    worst = int(np.abs(late).argmax())
    expect(
        False,
        (
            f"motion frame {worst} ({worst / 20:.2f} s) is matched with sound "
            f"{late[worst]:+.3f} s away from it"
        ),
    )


@check
def tracker_lag(mine):
    """Check mine(found, true).

    The tracker missed the first beat, and found two that do not exist. All others are 30 ms late.
    """
    true = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5])
    found = np.array([1.03, 1.53, 1.79, 2.03, 2.53, 3.03, 3.53, 5.0])
    gaps = np.array([0.03, 0.03, -0.21, 0.03, 0.03, 0.03, 0.03, 1.5])
    mistakes = {
        "late is found minus true, and should be positive": -0.03,
        "that is the mean, which the two wrong beats spoil": gaps.mean(),
        "that is the mean of absolute values, which the wrong beats spoil": np.abs(gaps).mean(),
        "beats are compared by their index; the tracker missed the first one": np.median(
            found[:7] - true
        ),
        "beats are compared by their index; the tracker missed the first": np.mean(
            found[:7] - true
        ),
    }
    expect_close(mine(found, true), 0.03, "the lag", mistakes)
    early = true[1:] - 0.01
    hint = {"the beats are early, so the lag is negative: do not take absolute values": 0.01}
    expect_close(mine(early, true), -0.01, "the lag of beats that come 10 ms early", hint)
    return "We can subtract a constant lag, but not a wrong beat."
