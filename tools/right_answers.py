"""Unusual right answers: other libraries, loops, other types, other orders of the same steps."""

import itertools
import math
import statistics

import numpy as np
import torch
from scipy import special, stats
from torch.nn import functional as F

from motiondiff_edu.conditions.control import joystick
from motiondiff_edu.cross_modal_attention import relative_position_bucket, rotary
from motiondiff_edu.motion.skeleton import LEFT, MIRROR

SIDES = {"left": "right", "right": "left"}


def _joystick():
    turn = math.radians(90) / 2
    return joystick([(2, 1.2, 0, 0), (2, 0.8, 0, -turn), (1, 0, 0, 0)])


def _two_digits():
    rows = [[1.2, 0, 0]] * 40 + [[0.8, 0, -0.79]] * 40 + [[0, 0, 0]] * 20
    return np.array(rows)


def _smooth_turn():
    """90 degrees with a turn that swells and ebbs."""
    control = np.zeros((100, 3))
    control[:40, 0], control[40:80, 0] = 1.2, 0.8
    swell = np.sin(np.pi * (np.arange(40) + 0.5) / 40)
    control[40:80, 2] = -swell * (np.pi / 2 * 20 / swell.sum())
    return control


def _by_index(past, new, T_h):
    control = np.empty((T_h + len(new), 3))
    control[: T_h - 1] = past[len(past) - T_h : -1]
    control[T_h - 1] = new[0]
    control[T_h:] = new
    return control


def _mirrored_by_hand(poses, control):
    poses = poses.copy()
    for left in LEFT:
        right = int(MIRROR[left])
        poses[:, [left, right]] = poses[:, [right, left]]
    poses[:, :, 0] = 0 - poses[:, :, 0]
    control = control.copy()
    control[:, 1:] *= -1
    return [poses, control]


def _with_noise(x0, s, alpha_bar, noise):
    parts = [
        math.sqrt(alpha_bar[k]) * x + math.sqrt(1 - alpha_bar[k]) * e
        for x, k, e in zip(x0, s, noise, strict=True)
    ]
    return torch.stack(parts)


def _precisions(x0, x_s, s, alpha_bar):
    alpha = alpha_bar[s] / alpha_bar[s - 1]
    first, second = 1 / (1 - alpha_bar[s - 1]), alpha / (1 - alpha)
    mean = first * alpha_bar[s - 1] ** 0.5 * x0 + second * x_s / alpha**0.5
    return [mean / (first + second), 1 / (first + second)]


def _ddpm(x0, x_s, s, alpha_bar):
    beta = 1 - alpha_bar[s] / alpha_bar[s - 1]
    left = (1 - alpha_bar[s - 1]) / (1 - alpha_bar[s])
    mean = alpha_bar[s - 1].sqrt() * beta / (1 - alpha_bar[s]) * x0
    return mean + (1 - beta).sqrt() * left * x_s, beta * left


def _best_in_numpy(x_s, alpha_bar, data):
    x = x_s.numpy()
    a = alpha_bar.numpy()
    d = data.numpy()
    far = ((x[:, None] - np.sqrt(a)[:, None, None] * d[None]) ** 2).sum(2)
    log = -far / (2 * (1 - a[:, None]))
    return np.einsum("bn,nd->bd", special.softmax(log, axis=1), d)


def _best_by_shift(x_s, alpha_bar, data):
    log = (x_s @ data.T) * (alpha_bar**0.5 / (1 - alpha_bar))[:, None]
    log = log - data.square().sum(1) * (alpha_bar / (2 * (1 - alpha_bar)))[:, None]
    weight = (log - log.max(1, keepdim=True).values).exp()
    return (weight / weight.sum(1, keepdim=True)) @ data


def _step_inline(x_s, s, eps_hat, beta, alpha_bar, z):
    alpha = 1 - beta[s]
    x = x_s / alpha.sqrt() - eps_hat * beta[s] / (1 - alpha_bar[s]).sqrt() / alpha.sqrt()
    return x + (s > 1) * beta[s].sqrt() * z


def _step_through_x0(x_s, s, eps_hat, beta, alpha_bar, z):
    x0 = (x_s - (1 - alpha_bar[s]) ** 0.5 * eps_hat) / alpha_bar[s] ** 0.5
    if s == 1:
        return x0
    share = beta[s] / (1 - alpha_bar[s])
    rest = (1 - beta[s]) ** 0.5 * (1 - alpha_bar[s - 1]) / (1 - alpha_bar[s])
    return alpha_bar[s - 1] ** 0.5 * share * x0 + rest * x_s + beta[s] ** 0.5 * z


def _leap_sigma(x, eps_hat, now, then, eta, z):
    sigma = eta * math.sqrt((1 - then) / (1 - now)) * math.sqrt(1 - now / then)
    mean = math.sqrt(then / now) * (x - math.sqrt(1 - now) * eps_hat)
    return mean + math.sqrt(max(0.0, 1 - then - sigma * sigma)) * eps_hat + sigma * z


def _leap_in_numpy(x, eps_hat, now, then, eta, z):
    return _leap_sigma(x.numpy(), eps_hat.numpy(), now, then, eta, z.numpy())


def _prior_in_numpy(x0, alpha_bar):
    x, a = x0.numpy(), float(alpha_bar)
    each = 0.5 * (a * np.square(x) - a - math.log1p(-a))
    return each.reshape(len(x), -1).sum(1)


def _weight_by_snr(beta, alpha_bar):
    """Half the difference of two signal-to-noise ratios, over what the two variances differ by."""
    snr = alpha_bar / (1 - alpha_bar)
    return 0.5 * snr[1:] * beta[1:] / ((1 - beta[1:]) * (1 - alpha_bar[1:]))


def _log_mean_by_hand(log_ratio):
    largest = log_ratio.max(0, keepdim=True).values
    return (log_ratio - largest).exp().mean(0).log() + largest[0]


def _heads_by_rearranging(x, heads):
    B, T, W = x.shape
    return x.reshape(B, T, heads, W // heads).movedim(2, 1)


def _bias_by_pairs(table, query, key):
    apart = key.reshape(1, -1) - query.reshape(-1, 1)
    return torch.einsum("tmh->htm", table[relative_position_bucket(apart)])


def _rollout_with_list(sample, past, control, frames, T_p):
    seen = past
    for t in range(frames):
        T_h = past.shape[1]
        rows = control[:, t : t + T_h]
        held = rows[:, -1:].expand(-1, T_p, -1)
        seen = torch.cat([seen, sample(seen[:, -T_h:], torch.cat([rows, held], 1))[:, :1]], 1)
    return seen[:, past.shape[1] :]


def _rollout_with_index(sample, past, control, frames, T_p):
    T_h = past.shape[1]
    out = torch.cat([past, past.new_zeros(len(past), frames, past.shape[2])], 1)
    for t in range(frames):
        index = torch.arange(t, t + T_h + T_p).clamp(max=t + T_h - 1)
        out[:, T_h + t] = sample(out[:, t : t + T_h], control[:, index])[:, 0]
    return out[:, T_h:]


def _skating_with_where(toes, fps=20, below=0.03):
    high = np.max([toes[1:, :, 1], toes[:-1, :, 1]], axis=0)
    step = toes[1:] - toes[:-1]
    metres = np.sqrt(step[:, :, 0] ** 2 + step[:, :, 2] ** 2)
    of_lower = np.where(high[:, 0] <= high[:, 1], metres[:, 0], metres[:, 1])
    return np.mean(of_lower[high.min(axis=1) < below]) * fps


def _skating_in_torch(toes, fps=20, below=0.03):
    toes = torch.tensor(np.ascontiguousarray(toes))
    high = torch.maximum(toes[1:, :, 1], toes[:-1, :, 1])
    lower = high.argmin(1, keepdim=True)
    speed = torch.hypot(*(toes[1:] - toes[:-1])[..., [0, 2]].unbind(-1)).gather(1, lower)
    return (speed[high.gather(1, lower) < below] * fps).mean().item()


def _merge_backwards(runs, gap):
    runs, merged = list(runs), []
    while runs:
        first, after = runs.pop()
        while runs and first - runs[-1][1] <= gap:
            first = runs.pop()[0]
        merged.insert(0, [first, after])
    return merged


def _merge_by_cuts(runs, gap):
    if not runs:
        return []
    cuts = [i for i in range(1, len(runs)) if runs[i][0] - runs[i - 1][1] > gap]
    edges = [0, *cuts, len(runs)]
    return np.array([(runs[a][0], runs[b - 1][1]) for a, b in itertools.pairwise(edges)])


def _batch_lerped(past, future, s, alpha_bar, rate, u, noise):
    a, b = (x[s].sqrt().reshape(-1, 1, 1) for x in (alpha_bar, 1 - alpha_bar))
    hit = (u < rate).double().reshape(-1, 1, 1)
    return past + hit * (a * past + b * noise[1] - past), torch.addcmul(a * future, b, noise[0])


def _products_by_masks(xx, past, rate, alpha_bar):
    n, is_past = len(xx), torch.arange(len(xx)) < past
    count = is_past[:, None].int() + is_past[None].int()
    root, share = alpha_bar.sqrt().mean(), alpha_bar.mean()
    factor = torch.where(count == 2, share, torch.where(count == 1, root, torch.ones(n, n)))
    ridge = torch.diag(is_past.double()) * (1 - alpha_bar).mean()
    return (1 - rate) * xx + rate * (factor * xx + ridge)


def _rate_by_bisect(done, rates, start):
    if done < start:
        return 0
    edges = [start + k * (1 - start) / len(rates) for k in range(len(rates))]
    return rates[sum(done >= edge - 1e-9 for edge in edges) - 1]


def _rate_by_numpy(done, rates, start):
    edges = np.linspace(start, 1, len(rates) + 1)[:-1] - 1e-9
    k = np.searchsorted(edges, done, side="right")
    return np.concatenate([[0], rates])[k]


def _reversed_by_index(control):
    T = control.shape[1]
    index = [max(T - 2 - t, 0) for t in range(T)]
    return -1 * control[:, index]


def _round_in_two(walk_on, past, known, mean, control):
    T = control.shape[1]
    filled = past.masked_fill(~known, 0) + (~known) * mean
    there = walk_on(filled, control)
    index = [max(T - 2 - t, 0) for t in range(T)]
    back = walk_on(torch.flip(there, [1]), 0 - control[:, index])
    out = past.clone()
    out[~known] = torch.flip(back, [1])[~known]
    return out


def _round_with_lerp(walk_on, past, known, mean, control):
    start = torch.where(known, past, mean.expand_as(past))
    there = walk_on(start, control)
    turned = torch.cat([control[:, :-1].flip(1), control[:, :1]], 1).neg()
    back = walk_on(there[:, [2, 1, 0]], turned)[:, [2, 1, 0]]
    return back.where(~known, past)


def _change_by_loop(before, after, known):
    out = []
    for b, a, k in zip(before, after, known, strict=True):
        holes = (a - b)[~k]
        out.append(holes.norm() / max(1, len(holes)) ** 0.5)
    return out


def _mel_by_time(T):
    times = np.arange(2 * T + 10) * 512 / 16000
    return np.abs(times[None] - np.arange(T)[:, None] / 20).argmin(1)


def _lag_by_scipy(found, true):
    middle = (true[1:] + true[:-1]) / 2
    return float(np.quantile(found - true[np.searchsorted(middle, found)], 0.5))


def _conv_by_three(x, weight, bias, stride):
    W = x.shape[1]
    zero = torch.zeros(1, W, dtype=x.dtype)
    before, after = torch.cat([zero, x[:-1]]), torch.cat([x[1:], zero])
    parts = zip((before, x, after), weight.split(W, dim=1), strict=True)
    return (sum(part @ w.T for part, w in parts) + bias)[list(range(0, len(x), stride))]


def _conv_by_unfold(x, weight, bias, stride):
    rows = F.pad(x, (0, 0, 1, 1)).unfold(0, 3, stride)  # (T', W, 3)
    return F.linear(rows.transpose(1, 2).flatten(1), weight, bias)


def _clocks_by_scaling(q, k, fps_q, fps_k, f):
    turn = 2 * torch.pi * f
    q = rotary(q, torch.outer(torch.arange(len(q)) / fps_q, turn))
    k = rotary(k, torch.outer(torch.arange(len(k)) / fps_k, turn))
    return F.softmax(torch.einsum("td,md->tm", q, k) * q.shape[1] ** -0.5, dim=1)


def _clocks_shifted(q, k, fps_q, fps_k, f):
    """A minute later on both clocks."""
    at = (60 + torch.arange(len(q), dtype=torch.float64) / fps_q)[:, None]
    to = (60 + torch.arange(len(k), dtype=torch.float64) / fps_k)[:, None]
    q, k = (rotary(x, 2 * math.pi * times * f) for x, times in ((q, at), (k, to)))
    return torch.softmax(q @ k.T / q.shape[-1] ** 0.5, 1)


def _one_multiple_more(network, x, multiple):
    return network(F.pad(x, (0, 0, 0, multiple - x.shape[1] % multiple)))[:, : x.shape[1]]


def _zeros_by_cat(network, x, multiple):
    more = math.ceil(x.shape[1] / multiple) * multiple - x.shape[1]
    whole = torch.cat([x, x.new_zeros(len(x), more, x.shape[2])], 1)
    return network(whole).narrow(1, 0, x.shape[1])


def _asymmetry_in_numpy(x0_hat, mean, std, bones, pairs):
    joints = (x0_hat * std + mean).numpy().reshape(len(x0_hat), -1, 3).copy()
    joints[:, 1:] += joints[:, :1]
    a, b = np.transpose(bones)
    lengths = np.linalg.norm(joints[:, b] - joints[:, a], axis=2)
    left, right = np.transpose(pairs)
    return np.abs(lengths[:, left] - lengths[:, right]).mean()


def _asymmetry_by_pair(x0_hat, mean, std, bones, pairs):
    about = (mean + std * x0_hat).unflatten(1, (-1, 3))
    joints = [about[:, 0], *(about[:, 0] + about[:, j] for j in range(1, about.shape[1]))]
    length = [(joints[c] - joints[p]).norm(dim=1) for p, c in bones]
    return sum((length[i] - length[j]).abs().mean() for i, j in pairs) / len(pairs)


def _put_in(x_s, given, known, alpha_bar, noise):
    x = x_s.clone()
    x[known] = (given * alpha_bar**0.5 + noise * (1 - alpha_bar) ** 0.5)[known]
    return x


def _masked_by_pairs(leap, snapshot, x, visited, given, known):
    for s, after in itertools.pairwise([*visited, 0]):
        x = x.where(~known, snapshot(s))
        x = leap(x, s, after)
    return given.where(known, x)


def _masked_by_index(leap, snapshot, x, visited, given, known):
    x, todo = x.clone(), list(visited)
    while todo:
        s = todo.pop(0)
        x[known] = snapshot(s)[known]
        x = leap(x, s, todo[0] if todo else 0)
    x[known] = given[known]
    return x


def _bag_by_matrix(tokens, mask):
    share = mask.to(tokens.dtype)
    return torch.einsum("bm,bmc->bc", share / share.sum(1, keepdim=True), tokens)


def _mirror_words(positions, words):
    seen = np.array(positions)[:, MIRROR]
    seen[..., 0] = -seen[..., 0]
    return [seen, [SIDES[w] if w in SIDES else w for w in words]]


def _mirror_by_text(positions, words):
    text = " ".join(words).replace("left", "*").replace("right", "left").replace("*", "right")
    return np.stack([-positions[:, MIRROR, 0], *positions[:, MIRROR, 1:].T.swapaxes(1, 2)], -1), (
        tuple(text.split())
    )


def _precision_by_rank(distances, k):
    shares = []
    for i, row in enumerate(distances):
        low = int((row < row[i]).sum())
        high = int((row <= row[i]).sum())
        shares.append(np.mean([rank < k for rank in range(low, high)]))
    return np.mean(shares)


def _precision_by_scipy(distances, k):
    shares = []
    for i, row in enumerate(distances):
        low = stats.rankdata(row, "min")[i] - 1
        high = stats.rankdata(row, "max")[i]
        shares.append(min(1.0, max(0.0, (k - low) / (high - low))))
    return statistics.fmean(shares)


RIGHT = {
    "right_turn": [_joystick, _two_digits, _smooth_turn],
    "splice_control": [
        _by_index,
        lambda past, new, T_h: np.vstack([past[-T_h:-1], new[:1], new]),
        lambda past, new, T_h: np.array([*past[len(past) - T_h : -1], new[0], *new]).tolist(),
    ],
    "lengths_of_bones": [
        lambda p, b: np.stack([np.sqrt(((p[:, c] - p[:, a]) ** 2).sum(1)) for a, c in b], 1),
        lambda p, b: [[math.dist(pose[a], pose[c]) for a, c in b] for pose in p],
        lambda p, b: torch.tensor(p)[:, torch.tensor(b)].diff(dim=2).norm(dim=-1).squeeze(-1),
    ],
    "place_in_world": [
        lambda pose, x, z, h: (
            pose @ np.array([[np.cos(h), 0, -np.sin(h)], [0, 1, 0], [np.sin(h), 0, np.cos(h)]])
            + [x, 0, z]
        ),
        lambda pose, x, z, h: np.array(
            [
                (
                    x + left * math.cos(h) + ahead * math.sin(h),
                    up,
                    z - left * math.sin(h) + ahead * math.cos(h),
                )
                for left, up, ahead in pose
            ]
        ),
        lambda pose, x, z, h: (
            pose[:, :1] * np.array([np.cos(h), 0, -np.sin(h)])
            + pose[:, 2:] * np.array([np.sin(h), 0, np.cos(h)])
            + pose * [0, 1, 0]
            + np.array([x, 0, z])
        ),
    ],
    "mirror_walk": [
        _mirrored_by_hand,
        lambda poses, control: (
            np.take(poses, MIRROR, axis=1) @ np.diag([-1, 1, 1]),
            control @ np.diag([1, -1, -1]),
        ),
        lambda poses, control: (
            np.stack([-poses[:, MIRROR, 0], poses[:, MIRROR, 1], poses[:, MIRROR, 2]], -1),
            torch.tensor(control) * torch.tensor([1, -1, -1]),
        ),
    ],
    "q_sample": [
        _with_noise,
        lambda x0, s, ab, e: (
            torch.einsum("b,btd->btd", ab[s].sqrt(), x0)
            + torch.einsum("b,btd->btd", (1 - ab[s]).sqrt(), e)
        ),
        lambda x0, s, ab, e: (
            ab.index_select(0, s).view(-1, 1, 1).sqrt().numpy() * x0.numpy()
            + np.sqrt(1 - ab[s].numpy()).reshape(-1, 1, 1) * e.numpy()
        ),
    ],
    "posterior": [
        _precisions,
        _ddpm,
        lambda x0, x_s, s, ab: tuple(torch.as_tensor(p) for p in _precisions(x0, x_s, s, ab)),
    ],
    "constant_beta": [
        lambda S, left: 1 - math.exp(2 * math.log(left) / S),
        lambda S, left: 1 - (left**2) ** (1 / S),
        lambda S, left: -torch.expm1(torch.tensor(2 / S * math.log(left), dtype=torch.float64)),
    ],
    "best_guess": [
        _best_in_numpy,
        _best_by_shift,
        lambda x_s, ab, data: torch.stack(
            [
                (-(x - a.sqrt() * data).pow(2).sum(1) / 2 / (1 - a)).softmax(0) @ data
                for x, a in zip(x_s, ab, strict=True)
            ]
        ),
    ],
    "step_back": [
        _step_inline,
        _step_through_x0,
        lambda x, s, e, b, ab, z: _step_inline(x, s, e, b, ab, z if s > 1 else 0 * z).numpy(),
    ],
    "leap": [
        _leap_sigma,
        _leap_in_numpy,
        lambda x, e, now, then, eta, z: _leap_sigma(x.double(), e.double(), now, then, eta, z),
    ],
    "prior_term": [
        _prior_in_numpy,
        lambda x0, ab: torch.distributions.kl_divergence(
            torch.distributions.Normal(ab.sqrt() * x0, (1 - ab).sqrt()),
            torch.distributions.Normal(torch.zeros_like(x0), 1.0),
        ).sum((1, 2)),
        lambda x0, ab: torch.stack(
            [0.5 * (ab * x.square() - ab - torch.log1p(-ab)).sum() for x in x0]
        ),
    ],
    "x0_weight": [
        _weight_by_snr,
        lambda b, ab: ab[:-1] * b[1:] / (2 * (1 - ab[1:]) ** 2),
        lambda b, ab: [
            float(b[s] * ab[s] / (2 * (1 - b[s]) * (1 - ab[s]) ** 2)) for s in range(1, len(b))
        ],
    ],
    "tighter_bound": [
        _log_mean_by_hand,
        lambda r: special.logsumexp(r.numpy(), axis=0, b=1 / len(r)),
        lambda r: torch.logsumexp(r - math.log(len(r)), 0),
    ],
    "back_to_x0": [
        lambda o, x, ab, t: {
            "x0": o,
            "eps": x / ab.sqrt() - (1 / ab - 1).sqrt() * o,
            "v": ab.sqrt() * x - (1 - ab).sqrt() * o,
        }[t],
        lambda o, x, ab, t: (
            o
            if t[0] == "x"
            else (x - (1 - ab) ** 0.5 * o) / ab**0.5
            if t == "eps"
            else torch.addcmul(ab**0.5 * x, (1 - ab) ** 0.5, o, value=-1)
        ),
        lambda o, x, ab, t: (
            o.numpy()
            if t == "x0"
            else (
                (x - (1 - ab).sqrt() * (o if t == "eps" else ab.sqrt() * o + (1 - ab).sqrt() * x))
                / ab.sqrt()
            ).numpy()
        ),
    ],
    "averaged_weights": [
        lambda means, new, d: [m - (1 - d) * (m - n) for m, n in zip(means, new, strict=True)],
        lambda means, new, d: tuple(
            np.average([m, n], axis=0, weights=[d, 1 - d]) for m, n in zip(means, new, strict=True)
        ),
        lambda means, new, d: [
            torch.tensor(m).lerp(torch.tensor(n), 1 - d) for m, n in zip(means, new, strict=True)
        ],
    ],
    "weight_between_losses": [
        lambda ab: 1 / ab - 1,
        lambda ab: ((1 - ab).sqrt() / ab.sqrt()) ** 2,
        lambda ab: [(1 - float(a)) / float(a) for a in ab],
    ],
    "attention_with_bias": [
        lambda q, k, v, b: F.scaled_dot_product_attention(q, k, v, attn_mask=b),
        lambda q, k, v, b: (
            special.softmax(
                (torch.einsum("td,md->tm", q, k) / q.shape[1] ** 0.5 + b).numpy(), axis=1
            )
            @ v.numpy()
        ),
        lambda q, k, v, b: torch.stack(
            [
                torch.softmax((k @ row) * k.shape[1] ** -0.5 + c, 0) @ v
                for row, c in zip(q, b, strict=True)
            ]
        ),
    ],
    "split_into_heads": [
        _heads_by_rearranging,
        lambda x, h: torch.stack(x.chunk(h, dim=-1), dim=1),
        lambda x, h: np.stack(np.split(x.numpy(), h, axis=2), axis=1),
    ],
    "relative_bias": [
        _bias_by_pairs,
        lambda t, q, k: t.T[:, relative_position_bucket(k - q[:, None])],
        lambda t, q, k: torch.stack([t[relative_position_bucket(k - one)].T for one in q], 1),
    ],
    "hold_control": [
        lambda c, T_h: torch.cat([c[:T_h], c[T_h - 1].expand(len(c) - T_h, -1)]),
        lambda c, T_h: c[torch.arange(len(c)).clamp(max=T_h - 1)],
        lambda c, T_h: np.array([*c[:T_h].numpy(), *[c[T_h - 1].numpy()] * (len(c) - T_h)]),
    ],
    "rollout_by_hand": [
        _rollout_with_list,
        _rollout_with_index,
        lambda sample, past, control, frames, T_p: _rollout_with_list(
            sample, past.clone(), control.contiguous(), frames, T_p
        ).numpy(),
    ],
    "toe_slide": [
        _skating_with_where,
        _skating_in_torch,
        lambda toes, fps=20, below=0.03: np.float32(_skating_with_where(toes, fps, below)),
    ],
    "merge_steps": [
        _merge_backwards,
        _merge_by_cuts,
        lambda runs, gap: [tuple(map(int, run)) for run in _merge_by_cuts(list(runs), gap)],
    ],
    "batch_with_dropout": [
        _batch_lerped,
        lambda *given: [part.numpy() for part in _batch_lerped(*given)],
        lambda *given: torch.stack(_batch_lerped(*given)),
    ],
    "dropped_products": [
        _products_by_masks,
        lambda *given: _products_by_masks(*given).numpy(),
        lambda xx, past, rate, ab: torch.stack(
            [_products_by_masks(xx, past, rate, ab[i : i + 1]) for i in range(len(ab))]
        ).mean(0),
    ],
    "rate_schedule": [
        _rate_by_bisect,
        _rate_by_numpy,
        lambda done, rates, start: torch.tensor(_rate_by_bisect(done, rates, start)),
    ],
    "time_reversal": [
        _reversed_by_index,
        lambda c: torch.cat([c[:, :-1].flip(1), c[:, :1]], 1).neg(),
        lambda c: -np.concatenate([c.numpy()[:, -2::-1], c.numpy()[:, :1]], 1),
    ],
    "there_and_back": [
        _round_in_two,
        _round_with_lerp,
        lambda *given: _round_in_two(*given).numpy(),
    ],
    "moved_by": [
        _change_by_loop,
        lambda b, a, k: (
            (a - b).masked_fill(k, 0).pow(2).sum((1, 2)) / (~k).sum((1, 2)).clamp(min=1)
        ).sqrt(),
        lambda b, a, k: np.nan_to_num(
            np.sqrt(np.ma.masked_array((a - b).numpy() ** 2, k.numpy()).mean((1, 2)).filled(0))
        ),
    ],
    "log_mel_from_spectrum": [
        lambda X, f, floor: torch.log(torch.clamp((X.real**2 + X.imag**2) @ f.T, floor)),
        lambda X, f, floor: np.log(
            np.maximum(np.einsum("mk,bk->mb", np.abs(X.numpy()) ** 2, f.numpy()), floor)
        ),
        lambda X, f, floor: ((X * X.conj()).real @ f.T).log().clamp(min=math.log(floor)),
    ],
    "mel_index": [
        _mel_by_time,
        lambda T: [round(t * 31.25 / 20) for t in range(T)],
        lambda T: torch.floor(torch.arange(T) * 1.5625 + 0.5),
    ],
    "tracker_lag": [
        _lag_by_scipy,
        lambda found, true: statistics.median(min((f - t for t in true), key=abs) for f in found),
        lambda found, true: torch.tensor(_lag_by_scipy(found, true)),
    ],
    "frame_conv": [
        _conv_by_three,
        _conv_by_unfold,
        lambda x, w, b, stride: (
            F.conv1d(x.T[None], w.unflatten(1, (3, -1)).transpose(1, 2), b, stride, padding=1)[0].T
        ),
    ],
    "any_length": [
        _one_multiple_more,
        _zeros_by_cat,
        lambda network, x, multiple: _one_multiple_more(network, x.clone(), multiple).numpy(),
    ],
    "clocks": [
        _clocks_by_scaling,
        _clocks_shifted,
        lambda *given: _clocks_by_scaling(*given).double().numpy(),
    ],
    "x0_hat": [
        lambda x, s, e, ab: torch.stack(
            [(x[i] - (1 - ab[k]).sqrt() * e[i]) / ab[k].sqrt() for i, k in enumerate(s)]
        ),
        lambda x, s, e, ab: (
            (x - (1 - ab)[s].sqrt().view(-1, 1, 1) * e) * ab[s].rsqrt().view(-1, 1, 1)
        ),
        lambda x, s, e, ab: (
            (x.numpy() - np.sqrt(1 - ab.numpy()[s.numpy()])[:, None, None] * e.numpy())
            / np.sqrt(ab.numpy()[s.numpy()])[:, None, None]
        ),
    ],
    "skeleton_loss": [
        lambda lengths: lengths.var(dim=0).mean(),
        lambda lengths: statistics.fmean(statistics.variance(bone.tolist()) for bone in lengths.T),
        lambda lengths: torch.cov(lengths.T).diagonal().mean(),
    ],
    "asymmetry_from_features": [
        _asymmetry_in_numpy,
        _asymmetry_by_pair,
        lambda *given: float(_asymmetry_by_pair(*given)),
    ],
    "shuffled_score": [
        lambda stops, songs, score: statistics.fmean(
            score(stops[i], songs[j]) for i, j in itertools.permutations(range(len(stops)), 2)
        ),
        lambda stops, songs, score: np.mean(
            [
                np.mean([score(dance, song) for j, song in enumerate(songs) if j != i])
                for i, dance in enumerate(stops)
            ]
        ),
        lambda stops, songs, score: (
            (sum(score(d, s) for d in stops for s in songs) - sum(map(score, stops, songs)))
            / (len(stops) * (len(stops) - 1))
        ),
    ],
    "expenditure": [
        lambda path, fps: np.linalg.norm(np.diff(path, n=2, axis=0), axis=1).mean() * fps**2,
        lambda path, fps: torch.tensor(path).diff(n=2, dim=0).norm(dim=1).mul(fps * fps).mean(),
        lambda path, fps: statistics.fmean(
            math.hypot(*(path[t] - 2 * path[t + 1] + path[t + 2])) * fps**2
            for t in range(len(path) - 2)
        ),
    ],
    "snapshot": [
        _put_in,
        lambda x, g, k, ab, e: x.where(~k, math.sqrt(ab) * g + math.sqrt(1 - ab) * e),
        lambda x, g, k, ab, e: np.where(k, np.sqrt(ab) * g + np.sqrt(1 - ab) * e, x),
    ],
    "masked": [_masked_by_pairs, _masked_by_index, lambda *given: _masked_by_pairs(*given).numpy()],
    "way_back": [
        lambda x, now, then, e: math.sqrt(then / now) * x + math.sqrt((now - then) / now) * e,
        lambda x, now, then, e: (then**0.5 * x + (now - then) ** 0.5 * e) / now**0.5,
        lambda x, now, then, e: (
            np.sqrt(then / now) * x.numpy() + np.sqrt(1 - then / now) * e.numpy()
        ),
    ],
    "bag": [
        _bag_by_matrix,
        lambda tokens, mask: [t[m].mean(0).tolist() for t, m in zip(tokens, mask, strict=True)],
        lambda tokens, mask: tokens.masked_fill(~mask[..., None], torch.nan).nanmean(1),
    ],
    "guided": [
        lambda a, b, w: w * a + (1 - w) * b,
        lambda a, b, w: torch.lerp(b, a, w),
        lambda a, b, w: a + (w - 1) * (a - b),
    ],
    "mirrored": [
        _mirror_words,
        _mirror_by_text,
        lambda positions, words: (
            torch.tensor(positions)[:, MIRROR.tolist()] * torch.tensor([-1.0, 1, 1]),
            np.array([SIDES.get(word, word) for word in words]),
        ),
    ],
    "r_precision": [
        _precision_by_rank,
        _precision_by_scipy,
        lambda distances, k: torch.tensor(_precision_by_rank(distances, k)),
    ],
    "edit_start": [
        lambda x, ab, e: math.sqrt(ab) * x + math.sqrt(1 - ab) * e,
        lambda x, ab, e: torch.add(x * ab**0.5, e, alpha=(1 - ab) ** 0.5),
        lambda x, ab, e: x.numpy() * np.sqrt(ab) + e.numpy() * np.sqrt(1 - ab),
    ],
    "composed": [
        lambda low, up, lower: lower * low + ~lower * up,
        lambda low, up, lower: up + lower * (low - up),
        lambda low, up, lower: np.where(lower, low, up),
    ],
}
