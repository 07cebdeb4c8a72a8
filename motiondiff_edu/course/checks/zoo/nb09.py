"""Wrong answers to the exercises of notebook 09."""

from collections.abc import Callable
from dataclasses import dataclass

import torch


def _shape(values):
    return values[:, None, None]


def _noised(x, s, alpha_bar, noise):
    return _shape(alpha_bar[s]) ** 0.5 * x + _shape(1 - alpha_bar[s]) ** 0.5 * noise


@dataclass(frozen=True, eq=False)
class _Fault:
    """Where a batch goes wrong; as it stands it is right."""

    hit: torch.Tensor | None = None  # which pasts are noised
    own: int = 1  # which of the two noises is the past's
    noised: Callable = _noised


def _batch(past, future, s, alpha_bar, rate, u, noise, fault=_Fault()):
    hit = u < rate if fault.hit is None else fault.hit
    seen = torch.where(_shape(hit), fault.noised(past, s, alpha_bar, noise[fault.own]), past)
    return seen, _noised(future, s, alpha_bar, noise[0])


def mask_inverted(past, future, s, alpha_bar, rate, u, noise):
    """Nearly every past is noise: the figure hardly learns to go on from where it is."""
    return _batch(past, future, s, alpha_bar, rate, u, noise, _Fault(hit=u > rate))


def one_throw_for_the_batch(past, future, s, alpha_bar, rate, u, noise):
    """All pasts of a batch are noised, or none.

    The gradient of one step in twenty has never seen a past.
    """
    fault = _Fault(hit=(u[0] < rate).expand(len(u)))
    return _batch(past, future, s, alpha_bar, rate, u, noise, fault)


def a_throw_for_each_frame(past, future, s, alpha_bar, rate, u, noise):
    """Single frames are noised, and the clean ones beside them tell all.

    Nothing has to come from the control.
    """
    hit = torch.rand(past.shape[:2], generator=torch.Generator().manual_seed(0)) < 0.5
    return torch.where(hit[..., None], _noised(past, s, alpha_bar, noise[1]), past), _noised(
        future, s, alpha_bar, noise[0]
    )


def same_noise_for_both(past, future, s, alpha_bar, rate, u, noise):
    """The past carries the very noise that is asked for.

    A low loss in training, and nothing to read in sampling.
    """
    return _batch(past, future, s, alpha_bar, rate, u, noise, _Fault(own=0))


def first_step_for_all(past, future, s, alpha_bar, rate, u, noise):
    """One step for the whole batch where each sample has its own."""
    return _batch(past, future, s[:1].expand(len(s)), alpha_bar, rate, u, noise)


def past_at_the_first_step(past, future, s, alpha_bar, rate, u, noise):
    """The future is right; the past is noised as the first sample's is."""
    _, x_s = _batch(past, future, s, alpha_bar, rate, u, noise)
    return _batch(past, future, s[:1].expand(len(s)), alpha_bar, rate, u, noise)[0], x_s


def rescaled(past, future, s, alpha_bar, rate, u, noise):
    """As nn.Dropout does it: a clean past is larger in training than it will ever be in use."""
    seen, x_s = _batch(past, future, s, alpha_bar, rate, u, noise)
    return seen / (1 - rate), x_s


def zeroed(past, future, s, alpha_bar, rate, u, noise):
    """Sets to zero, whatever the step."""
    return _batch(past, future, s, alpha_bar, rate, u, noise, _Fault(noised=lambda x, *_: 0 * x))


def not_shrunk(past, future, s, alpha_bar, rate, u, noise):
    """Noise on top of the whole signal: the past is louder than the data have ever been."""
    fault = _Fault(noised=lambda x, s, t, e: x + _shape(1 - t[s]) ** 0.5 * e)
    return _batch(past, future, s, alpha_bar, rate, u, noise, fault)


def no_roots(past, future, s, alpha_bar, rate, u, noise):
    """Takes shares of power for amplitudes: signal and noise together are too small."""
    wrong = lambda x, s, t, e: _shape(t[s]) * x + _shape(1 - t[s]) * e  # noqa: E731
    return _batch(past, future, s, alpha_bar, rate, u, noise, _Fault(noised=wrong))


def changed_in_place(past, future, s, alpha_bar, rate, u, noise):
    """Right once; in the next epoch the data are noise."""
    x_s = _noised(future, s, alpha_bar, noise[0])
    past[u < rate] = _noised(past, s, alpha_bar, noise[1])[u < rate]
    return past, x_s


def future_changed_in_place(past, future, s, alpha_bar, rate, u, noise):
    """The targets are noise from the second epoch on."""
    seen, x_s = _batch(past, future, s, alpha_bar, rate, u, noise)
    future[:] = x_s
    return seen, future


def noise_subtracted(past, future, s, alpha_bar, rate, u, noise):
    """A minus before the noise: as likely a noise, but eps_hat is asked for the other sign."""
    return _batch(past, future, s, alpha_bar, rate, u, -noise)


def noise_subtracted_from_the_past(past, future, s, alpha_bar, rate, u, noise):
    """The future is right; in the past the noise has a minus."""
    return _batch(past, future, s, alpha_bar, rate, u, torch.stack([noise[0], -noise[1]]))


def noise_of_its_own(past, future, s, alpha_bar, rate, u, noise):
    """Draws anew where the noise is given: the loss does not know what was added."""
    return _batch(past, future, s, alpha_bar, rate, u, torch.randn_like(noise))


def lists_of_samples(past, future, s, alpha_bar, rate, u, noise):
    """The right numbers, sample by sample, never stacked."""
    return tuple(list(part) for part in _batch(past, future, s, alpha_bar, rate, u, noise))


def _expected(xx, past, keep, share, floor):
    out = xx.clone()
    out[:past, :past] = share * xx[:past, :past] + floor * torch.eye(past)
    out[:past, past:], out[past:, :past] = keep * xx[:past, past:], keep * xx[past:, :past]
    return out


def one_root_in_the_past(xx, past, rate, alpha_bar):
    """Shrinks past times past as if only one of the two were noised."""
    keep = 1 - rate + rate * alpha_bar.sqrt().mean()
    return _expected(xx, past, keep, keep, rate * (1 - alpha_bar).mean())


def root_of_the_mean(xx, past, rate, alpha_bar):
    """Root and mean may not change places: too much seems to be kept."""
    share = 1 - rate + rate * alpha_bar.mean()
    return _expected(
        xx, past, 1 - rate + rate * alpha_bar.mean().sqrt(), share, rate * (1 - alpha_bar).mean()
    )


def no_noise(xx, past, rate, alpha_bar):
    """Shrinks and adds nothing, so that there is no ridge."""
    share = 1 - rate + rate * alpha_bar.mean()
    return _expected(xx, past, 1 - rate + rate * alpha_bar.sqrt().mean(), share, 0.0)


def variance_subtracted(xx, past, rate, alpha_bar):
    """A minus before the noise's variance: the ridge is a pit."""
    share = 1 - rate + rate * alpha_bar.mean()
    keep = 1 - rate + rate * alpha_bar.sqrt().mean()
    return _expected(xx, past, keep, share, -rate * (1 - alpha_bar).mean())


def mean_squared(xx, past, rate, alpha_bar):
    """Takes k * k for past times past, as if its two factors were drawn apart."""
    keep = 1 - rate + rate * alpha_bar.sqrt().mean()
    return _expected(xx, past, keep, keep**2, rate * (1 - alpha_bar).mean())


def all_dropped(xx, past, rate, alpha_bar):
    """Forgets that most pasts are clean."""
    return _expected(xx, past, alpha_bar.sqrt().mean(), alpha_bar.mean(), (1 - alpha_bar).mean())


def control_dropped_too(xx, past, rate, alpha_bar):
    """Puts the noise on the whole diagonal: then no weight could move to the control."""
    share = 1 - rate + rate * alpha_bar.mean()
    floor = rate * (1 - alpha_bar).mean()
    right = _expected(xx, past, 1 - rate + rate * alpha_bar.sqrt().mean(), share, floor)
    right[past:, past:] += floor * torch.eye(len(xx) - past)
    return right


def shares_inverted(xx, past, rate, alpha_bar):
    """`rate` and 1 - rate change places; at a rate of 1/2 nobody notices."""
    share = rate + (1 - rate) * alpha_bar.mean()
    keep = rate + (1 - rate) * alpha_bar.sqrt().mean()
    return _expected(xx, past, keep, share, (1 - rate) * (1 - alpha_bar).mean())


def without_start(done, rates, start):
    """Begins with the first rate at once."""
    return rates[min(int(done * len(rates)), len(rates) - 1)]


def at_once(done, rates, start):
    """From nothing to the highest rate in one step."""
    return 0.0 if done < start else rates[-1]


def downwards(done, rates, start):
    """The hardest first."""
    return (
        0.0
        if done < start
        else rates[::-1][min(int((done - start) / (1 - start) * len(rates)), len(rates) - 1)]
    )


def gliding(done, rates, start):
    """Rises evenly where the paper rises in steps."""
    return max(0.0, (done - start) / (1 - start)) * rates[-1]


def over_the_whole(done, rates, start):
    """Shares the whole training among the rates, so that the first ones pass before the start."""
    return 0.0 if done < start else rates[min(int(done * len(rates)), len(rates) - 1)]


def nothing_after_the_last(done, rates, start):
    """When all is done there is no entry of the list left."""
    k = int((done - start) / (1 - start) * len(rates) + 1e-9)
    return 0.0 if done < start or k >= len(rates) else rates[k]


ZOO = {
    "batch_with_dropout": {
        "mask inverted": mask_inverted,
        "one throw for the batch": one_throw_for_the_batch,
        "a throw for each frame": a_throw_for_each_frame,
        "the same noise for past and future": same_noise_for_both,
        "the first step for all": first_step_for_all,
        "the past at the first sample's step": past_at_the_first_step,
        "rescaled as nn.Dropout": rescaled,
        "zeroed": zeroed,
        "the signal not shrunk": not_shrunk,
        "no roots": no_roots,
        "changed in place": changed_in_place,
        "the future changed in place": future_changed_in_place,
        "noise subtracted": noise_subtracted,
        "noise subtracted from the past": noise_subtracted_from_the_past,
        "noise of its own": noise_of_its_own,
        "lists of samples": lists_of_samples,
    },
    "dropped_products": {
        "one root in past times past": one_root_in_the_past,
        "root of the mean": root_of_the_mean,
        "no noise": no_noise,
        "noise subtracted": variance_subtracted,
        "mean squared": mean_squared,
        "all dropped": all_dropped,
        "control dropped, too": control_dropped_too,
        "shares inverted": shares_inverted,
    },
    "rate_schedule": {
        "no start": without_start,
        "at once": at_once,
        "downwards": downwards,
        "gliding": gliding,
        "over the whole training": over_the_whole,
        "nothing after the last": nothing_after_the_last,
    },
}
