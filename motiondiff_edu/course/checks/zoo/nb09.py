"""Wrong answers to the exercises of notebook 09."""

from collections.abc import Callable
from dataclasses import dataclass

import torch


def _shape(values):
    return values[:, None, None]


def _noised(x, s, alpha_bar, noise):
    return _shape(alpha_bar[s]) ** 0.5 * x + _shape(1 - alpha_bar[s]) ** 0.5 * noise


# equation 12 with one thing wrong in each; the same for past and future
NOISED = {
    "square roots are missing: alpha_bar is a share of power, not of amplitude": (
        lambda x, s, t, e: _shape(t[s]) * x + _shape(1 - t[s]) * e
    ),
    "the root of alpha_bar is missing": lambda x, s, t, e: (
        _shape(t[s]) * x + _shape(1 - t[s]) ** 0.5 * e
    ),
    "the root of 1 - alpha_bar is missing": lambda x, s, t, e: (
        _shape(t[s]) ** 0.5 * x + _shape(1 - t[s]) * e
    ),
    "the noise is scaled by the root of 1 - alpha_bar, not by 1 minus the root": (
        lambda x, s, t, e: _shape(t[s]) ** 0.5 * x + (1 - _shape(t[s]) ** 0.5) * e
    ),
    "the signal is not scaled: multiply it by the root of alpha_bar": lambda x, s, t, e: (
        x + _shape(1 - t[s]) ** 0.5 * e
    ),
    "signal and noise are swapped": lambda x, s, t, e: _noised(e, s, t, x),
    "the noise is missing": lambda x, s, t, e: _shape(t[s]) ** 0.5 * x,
    "you subtracted the noise; add it": lambda x, s, t, e: _noised(x, s, t, -e),
    "every sample has its own step; this uses the first one's for all": lambda x, s, t, e: _noised(
        x, s[:1].expand(len(s)), t, e
    ),
    "this takes alpha_bar one step too early; the table begins at s = 0": lambda x, s, t, e: (
        _noised(x, s - 1, t, e)
    ),
}


@dataclass(frozen=True, eq=False)
class _Fault:
    """Where a batch goes wrong; as it stands it is right."""

    hit: Callable = lambda u, rate: u < rate  # which pasts are noised
    own: int = 1  # which of the two noises is the past's
    noised: Callable = _noised  # for the past
    of_future: Callable = _noised
    first: int = 0  # which of the two noises is the future's


def _batch(past, future, s, alpha_bar, rate, u, noise, fault):
    hit = _shape(fault.hit(u, rate))
    seen = torch.where(hit, fault.noised(past, s, alpha_bar, noise[fault.own]), past)
    return seen, fault.of_future(future, s, alpha_bar, noise[fault.first])


def _wrong(fault):
    return lambda *given: _batch(*given, fault)


def a_throw_for_each_frame(past, future, s, alpha_bar, rate, u, noise):
    """Single frames are noised, and the clean ones beside them tell all."""
    hit = torch.rand(past.shape[:2], generator=torch.Generator().manual_seed(0)) < 0.5
    seen = torch.where(hit[..., None], _noised(past, s, alpha_bar, noise[1]), past)
    return seen, _noised(future, s, alpha_bar, noise[0])


def rescaled(past, future, s, alpha_bar, rate, u, noise):
    """As nn.Dropout does it: a clean past is larger in training than it will ever be in use."""
    seen, x_s = _batch(past, future, s, alpha_bar, rate, u, noise, _Fault())
    return seen / (1 - rate), x_s


def clean_ones_rescaled(past, future, s, alpha_bar, rate, u, noise):
    """Divides the pasts without noise only."""
    seen, x_s = _batch(past, future, s, alpha_bar, rate, u, noise, _Fault())
    return torch.where(_shape(u < rate), seen, past / (1 - rate)), x_s


def swapped(past, future, s, alpha_bar, rate, u, noise):
    """The right numbers in the wrong order."""
    return _batch(past, future, s, alpha_bar, rate, u, noise, _Fault())[::-1]


def changed_in_place(past, future, s, alpha_bar, rate, u, noise):
    """Right once; in the next epoch the data are noise."""
    x_s = _noised(future, s, alpha_bar, noise[0])
    past[u < rate] = _noised(past, s, alpha_bar, noise[1])[u < rate]
    return past, x_s


def future_changed_in_place(past, future, s, alpha_bar, rate, u, noise):
    """The targets are noise from the second epoch on."""
    seen, x_s = _batch(past, future, s, alpha_bar, rate, u, noise, _Fault())
    future[:] = x_s
    return seen, future


def noise_of_its_own(past, future, s, alpha_bar, rate, u, noise):
    """Draws anew where the noise is given: the loss does not know what was added."""
    return _batch(past, future, s, alpha_bar, rate, u, torch.randn_like(noise), _Fault())


def lists_of_samples(past, future, s, alpha_bar, rate, u, noise):
    """The right numbers, sample by sample, never stacked."""
    both = _batch(past, future, s, alpha_bar, rate, u, noise, _Fault())
    return tuple(list(part) for part in both)


def _keep(rate, alpha_bar):
    return 1 - rate + rate * alpha_bar.sqrt().mean()


def _share(rate, alpha_bar):
    return 1 - rate + rate * alpha_bar.mean()


def _floor(rate, alpha_bar):
    return rate * (1 - alpha_bar).mean()


def _products(keep=_keep, share=_share, floor=_floor, floor_of=torch.eye):
    """The right products, but for factors given as functions of (rate, alpha_bar)."""

    def answer(xx, past, rate, alpha_bar):
        out = xx.clone()
        kept = keep(rate, alpha_bar)
        more = floor(rate, alpha_bar) * floor_of(past)
        out[:past, :past] = share(rate, alpha_bar) * xx[:past, :past] + more
        out[:past, past:] = kept * xx[:past, past:]
        out[past:, :past] = kept * xx[past:, :past]
        return out

    return answer


def _everywhere(xx, past, rate, alpha_bar):
    """Noise on the whole diagonal, also on the control's."""
    out = _products()(xx, past, rate, alpha_bar)
    rest = torch.zeros(len(xx))
    rest[past:] = _floor(rate, alpha_bar)
    return out + torch.diag(rest)


def control_dropped_too(xx, past, rate, alpha_bar):
    """Drops the control with the past."""
    out = _share(rate, alpha_bar) * xx
    rest = torch.zeros(len(xx))
    rest[:past] = _floor(rate, alpha_bar)
    return out + torch.diag(rest)


def products_in_place(xx, past, rate, alpha_bar):
    """Right numbers; the products of the clean pasts are gone."""
    xx[:] = _products()(xx, past, rate, alpha_bar)
    return xx


def one_side_only(xx, past, rate, alpha_bar):
    """Scales past times control, but not control times past: the matrix is no longer symmetric."""
    out = _products()(xx, past, rate, alpha_bar)
    out[past:, :past] = xx[past:, :past]
    return out


def _index(done, rates, start):
    return int((done - start) / (1 - start) * len(rates) + 1e-9)


def _scheduled(done, rates, start):
    return 0.0 if done < start else rates[min(_index(done, rates, start), len(rates) - 1)]


def nothing_after_the_last(done, rates, start):
    """When all is done there is no entry of the list left."""
    k = _index(done, rates, start)
    return 0.0 if done < start or k >= len(rates) else rates[k]


def one_rate_late(done, rates, start):
    """The first rate comes when the second should."""
    k = _index(done, rates, start) - 1
    return 0.0 if done < start or k < 0 else rates[min(k, len(rates) - 1)]


def rounded(done, rates, start):
    """Each rate but the first comes half its part too early."""
    k = round((done - start) / (1 - start) * len(rates))
    return 0.0 if done < start else rates[min(k, len(rates) - 1)]


MISTAKES = {
    "batch_with_dropout": {
        "past and future are swapped in what you return": swapped,
        "the mask is inverted: the pasts with `u < rate` are noised": _wrong(
            _Fault(hit=lambda u, rate: u >= rate)
        ),
        "every past is noised; each sample has its own u, and only u < rate means noise": _wrong(
            _Fault(hit=lambda u, rate: u < 2)
        ),
        "no past is noised yet": _wrong(_Fault(hit=lambda u, rate: u > 2)),
        "one u decides for the whole batch; each sample has its own": (
            _wrong(_Fault(hit=lambda u, rate: (u[:1] < rate).expand(len(u)))),
            _wrong(_Fault(hit=lambda u, rate: (u.mean() < rate).expand(len(u)))),
        ),
        "past and future have the same noise: the network could read the answer off the past": (
            _wrong(_Fault(own=0))
        ),
        "the first noise belongs to the future, the second to the past": (
            _wrong(_Fault(own=0, first=1)),
            _wrong(_Fault(first=1)),
        ),
        "this sets the past to zero; eq. 12 scales it and adds noise": _wrong(
            _Fault(noised=lambda x, *_: 0 * x)
        ),
        "this is noise alone; eq. 12 keeps a share of the past": _wrong(
            _Fault(noised=lambda x, s, t, e: e)
        ),
        "do not divide by 1 - rate: only nn.Dropout does that": rescaled,
        "pasts without noise stay as they are: only nn.Dropout divides by 1 - rate": (
            clean_ones_rescaled
        ),
        "the future is not noised": _wrong(_Fault(of_future=lambda x, *_: x)),
        "the future is always noised, not with probability `rate`": lambda past, future, *more: (
            _batch(past, future, *more, _Fault())[0],
            _batch(future, past, *more, _Fault(own=0))[0],
        ),
        **{
            hint: (
                _wrong(_Fault(noised=wrong)),
                _wrong(_Fault(of_future=wrong)),
                _wrong(_Fault(noised=wrong, of_future=wrong)),
            )
            for hint, wrong in NOISED.items()
        },
    },
    "dropped_products": {
        "past times past has two factors sqrt(alpha_bar): their product is alpha_bar itself": (
            _products(share=_keep)
        ),
        "past times control has one factor sqrt(alpha_bar), not two": _products(keep=_share),
        "this is the root of the mean; take the mean of the roots": _products(
            keep=lambda rate, alpha_bar: 1 - rate + rate * alpha_bar.mean().sqrt()
        ),
        "past times control is scaled as well": _products(keep=lambda rate, alpha_bar: 1.0),
        "past times past has the mean of squares, not the square of the mean root": _products(
            share=lambda rate, alpha_bar: _keep(rate, alpha_bar) ** 2
        ),
        "in a noised past, past times past has the mean of squares, not the square of the mean": (
            _products(share=lambda rate, alpha_bar: 1 - rate + rate * alpha_bar.sqrt().mean() ** 2)
        ),
        "the variance of the noise is added, whatever the noise's sign": _products(
            floor=lambda rate, alpha_bar: -rate * (1 - alpha_bar).mean()
        ),
        "past times past is not scaled": _products(share=lambda rate, alpha_bar: 1.0),
        "the noise is missing: add its variance on the diagonal": _products(
            floor=lambda rate, alpha_bar: 0.0
        ),
        "only a share `rate` of the pasts is noised": _products(
            keep=lambda rate, alpha_bar: alpha_bar.sqrt().mean(),
            share=lambda rate, alpha_bar: alpha_bar.mean(),
            floor=lambda rate, alpha_bar: (1 - alpha_bar).mean(),
        ),
        "the noise is there only with probability `rate`, too": _products(
            floor=lambda rate, alpha_bar: (1 - alpha_bar).mean()
        ),
        "the pasts that are not noised are missing: their share is 1 - rate": _products(
            keep=lambda rate, alpha_bar: rate * alpha_bar.sqrt().mean(),
            share=lambda rate, alpha_bar: rate * alpha_bar.mean(),
        ),
        "the variance of the noise is 1 - alpha_bar, without a root": _products(
            floor=lambda rate, alpha_bar: rate * (1 - alpha_bar).sqrt().mean()
        ),
        "the variance of the noise is 1 - alpha_bar, not alpha_bar": _products(
            floor=lambda rate, alpha_bar: rate * alpha_bar.mean()
        ),
        "rate and 1 - rate are swapped: 1 - rate of the pasts are clean": _products(
            keep=lambda rate, alpha_bar: _keep(1 - rate, alpha_bar),
            share=lambda rate, alpha_bar: _share(1 - rate, alpha_bar),
            floor=lambda rate, alpha_bar: (1 - rate) * (1 - alpha_bar).mean(),
        ),
        "only the past has noise; the control's diagonal stays": _everywhere,
        "the noises are independent: only the diagonal gets their variance": _products(
            floor_of=lambda past: torch.ones(past, past)
        ),
        "the control is never dropped: its products stay": control_dropped_too,
        "both blocks of past and control are scaled: the matrix is symmetric": one_side_only,
        "take the mean over the steps, not the sum": (
            _products(
                keep=lambda rate, alpha_bar: 1 - rate + rate * alpha_bar.sqrt().sum(),
                share=lambda rate, alpha_bar: 1 - rate + rate * alpha_bar.sum(),
                floor=lambda rate, alpha_bar: rate * (1 - alpha_bar).sum(),
            ),
            _products(floor=lambda rate, alpha_bar: rate * (1 - alpha_bar).sum()),
        ),
        "every step has its own alpha_bar; this uses the first one for all": (
            lambda xx, past, rate, alpha_bar: _products()(xx, past, rate, alpha_bar[:1])
        ),
    },
    "rate_schedule": {
        "the rates begin at once: until `start` the rate is 0": lambda done, rates, start: rates[
            min(int(done * len(rates)), len(rates) - 1)
        ],
        "the rate jumps to the last one at once; it rises step by step": (
            lambda done, rates, start: 0.0 if done < start else rates[-1]
        ),
        "the first rate stays; it rises step by step": lambda done, rates, start: (
            0.0 if done < start else rates[0]
        ),
        "the rates go down from the highest one; they should rise": lambda done, rates, start: (
            _scheduled(done, rates[::-1], start)
        ),
        "the rate rises in steps, not continuously": lambda done, rates, start: (
            max(0.0, (done - start) / (1 - start)) * rates[-1]
        ),
        "the first rate is missing, or comes too late: each rate has an equal part of the time "
        "left": one_rate_late,
        "the rates share the time after `start`, not the whole training": (
            lambda done, rates, start: (
                0.0 if done < start else rates[min(int(done * len(rates)), len(rates) - 1)]
            ),
            lambda done, rates, start: (
                0.0
                if done < start
                else rates[min(int((done - start) * len(rates)), len(rates) - 1)]
            ),
        ),
        "the rates are 0 after `start` and not before it": lambda done, rates, start: (
            _scheduled(start + done * (1 - start), rates, start) if done < start else 0.0
        ),
        "each rate begins with its part: round down, not to the nearest": rounded,
        "the last rate stays until the end": nothing_after_the_last,
        "at `start` itself the first rate begins": lambda done, rates, start: (
            0.0 if done <= start else _scheduled(done, rates, start)
        ),
    },
}
OTHERS = {
    "batch_with_dropout": {
        "a throw for each frame": a_throw_for_each_frame,
        "changed in place": changed_in_place,
        "the future changed in place": future_changed_in_place,
        "noise of its own": noise_of_its_own,
        "lists of samples": lists_of_samples,
    },
    "dropped_products": {"in place": products_in_place},
}
