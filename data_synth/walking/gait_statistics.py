"""Statistics of a walk: one value per statistic and clip, measured as on real walks.

Lengths are in mm (step length in m), angles in degrees, times in seconds, unless the name differs.
"""

import numpy as np
from jaxtyping import Float
from scipy.ndimage import gaussian_filter1d
from scipy.signal import welch

from .gait_cycles import GRID, Cycle, Walk, analyse, curves, cycles, over_cycle

AT = {p: int(round(p / 2)) for p in range(0, 101, 2)}  # index in GRID of a percentage


def statistics(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0) -> dict[str, float]:
    """All statistics of one clip of steady walking or running.

    Raises ValueError when it has no steady cycle.
    """
    walk = analyse(world, fps)
    found, c = cycles(walk), curves(walk)
    if not found:
        raise ValueError(
            "no steady gait cycle in this clip: "
            "it must walk straight for at least two steps of each foot"
        )
    rows = [_of_cycle(walk, cycle, c) for cycle in found]
    out = {k: float(np.mean([r[k] for r in rows])) for k in rows[0]}
    out["cycles"] = len(found)
    out |= _variation(walk, found, rows, c) | _kinematics(walk)
    out["step_width"] = _width(walk, found)
    return out


def mean_curves(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0) -> dict[str, np.ndarray]:
    """Curves of the own side over the cycle (0, 2, ... 100 %), averaged over steady cycles."""
    walk = analyse(world, fps)
    found, c = cycles(walk), curves(walk)
    names = (
        "thigh",
        "knee",
        "ankle",
        "hand",
        "elbow",
        "pelvis_yaw",
        "thorax_yaw",
        "pelvis_roll",
        "toe_y",
        "foot_y",
    )
    out = {n: np.mean([over_cycle(c[f"{n}{k.side}"], k) for k in found], 0) for n in names}
    y = np.mean([over_cycle(c["hips_y"], k) for k in found], 0)
    return out | {"hips_y": y - y.mean()}


def turning_lean(world: Float[np.ndarray, "T 21 3"], fps: float = 20.0) -> tuple[float, float]:
    """Slope and correlation of the whole body's lean against atan(v w / g), inward positive.

    The lean is measured from mid-ankles to neck.
    """
    walk = analyse(world, fps)
    body = gaussian_filter1d(
        world[:, 11] - (world[:, 3] + world[:, 7]) / 2, 0.4 * fps, axis=0, mode="nearest"
    )
    turn = np.gradient(np.unwrap(np.arctan2(walk.travel[:, 0], walk.travel[:, 1]))) * fps
    turn = gaussian_filter1d(turn, 0.4 * fps, mode="nearest")
    left = body[:, 0] * walk.travel[:, 1] - body[:, 2] * walk.travel[:, 0]
    lean = np.arctan2(left, body[:, 1])
    needed = np.arctan(walk.speed * turn / 9.81)
    on = slice(round(fps), -round(fps))
    return float(np.polyfit(needed[on], lean[on], 1)[0]), float(
        np.corrcoef(needed[on], lean[on])[0, 1]
    )


def _of_cycle(walk: Walk, k: Cycle, c: dict) -> dict[str, float]:
    s = k.side
    o = 1 - k.side
    fps = walk.fps
    own = {
        n: over_cycle(c[f"{n}{s}"], k)
        for n in ("thigh", "knee", "hand", "elbow", "toe_y", "foot_y", "pelvis_yaw")
    }
    both = {n: over_cycle(c[n], k) for n in ("hips_y", "lean", "head")}
    time = (k.end - k.start) / fps
    v = walk.speed[k.start : k.end].mean()
    down = walk.down[k.start : k.end]
    hips = over_cycle(walk.world[:, 0], k)
    out = {
        "v": v,
        "cadence": 120 / time,
        "step_length": v * time / 2,
        "stance": (k.toe_off - k.start) / fps / time,
    }
    out |= {"double_support": (down.sum(1) == 2).mean(), "flight": (down.sum(1) == 0).mean()}
    out |= _feet(walk, k, own) | _pelvis(walk, k, hips, both["hips_y"], own, c)
    out["lean"] = both["lean"].mean()
    out["lean_swing"] = np.ptp(_detrend(both["lean"]))
    head = over_cycle(walk.world[:, 12], k)
    out |= {
        "head_vertical": 1e3 * np.ptp(_detrend(head[:, 1])),
        "head_lateral": 1e3 * np.ptp(_across(walk, k, head)),
    }
    out["head_pitch"] = np.ptp(both["head"])
    opposite = over_cycle(c[f"thigh{o}"], k)
    out |= {
        "arm_swing": np.ptp(own["hand"]),
        "hand_thigh_r": np.corrcoef(own["hand"], opposite)[0, 1],
    }
    out |= {
        "elbow": own["elbow"].mean(),
        "elbow_range": np.ptp(own["elbow"]),
        "thigh_range": np.ptp(own["thigh"]),
    }
    knee = own["knee"]
    peak = AT[50] + np.argmax(knee[AT[50] : AT[92]])
    load = np.argmax(knee[: AT[30]])
    dip = knee[load : AT[60]].min()
    out |= {
        "knee_peak": knee[peak],
        "knee_rise": knee[load] - knee[0],
        "knee_fall": knee[load] - dip,
    }
    return out | {"knee_min": knee.min(), "knee_load_at": 2 * load, "knee_peak_at": 2 * peak}


def _detrend(y: np.ndarray) -> np.ndarray:
    return y - y[0] - (y[-1] - y[0]) * GRID


def _across(walk: Walk, k: Cycle, p: np.ndarray) -> np.ndarray:
    """Movement perpendicular to the path of the cycle, detrended, left positive."""
    d = p[-1, [0, 2]] - p[0, [0, 2]]
    d = d / np.linalg.norm(d)
    return _detrend(p[:, 0] * d[1] - p[:, 2] * d[0])


def _feet(walk: Walk, k: Cycle, own: dict) -> dict[str, float]:
    toe = walk.world[:, 4 + 4 * k.side]
    a, b = (k.start + int(round(f * (k.end - k.start))) for f in (0.15, 0.40))
    moves = np.linalg.norm(np.diff(toe[a : b + 1][:, [0, 2]], axis=0), axis=-1)
    y = 1e3 * (own["toe_y"] - np.median(own["toe_y"][AT[16] : AT[40]]))
    swing = y[AT[60] :]
    first = AT[60] + int(np.argmax(y[AT[60] : AT[82]]))
    out = {"slip": 1e3 * moves.mean(), "toe_below": y.min(), "toe_lift": swing.max()}
    out["clearance"] = y[first : AT[94]].min()
    return out | {"ankle_lift": 1e3 * (own["foot_y"].max() - walk.level[k.side])}


def _pelvis(
    walk: Walk, k: Cycle, hips: np.ndarray, hips_y: np.ndarray, own: dict, c: dict
) -> dict[str, float]:
    y = _detrend(hips_y)
    phase = np.angle(np.sum(y[:-1] * np.exp(-4j * np.pi * GRID[:-1]))) / (4 * np.pi)
    lateral = _across(walk, k, hips) * (1 if k.side == 0 else -1)
    lateral = lateral - lateral.mean()
    ahead = (np.gradient(walk.world[:, 0][:, [0, 2]], axis=0) * walk.fps * walk.travel).sum(-1)
    v = over_cycle(ahead, k)
    thorax = over_cycle(c[f"thorax_yaw{k.side}"], k)
    pelvis = own["pelvis_yaw"]
    wave = np.exp(-2j * np.pi * GRID[:-1])
    trail = np.degrees(np.angle(np.sum(pelvis[:-1] * wave) / np.sum(thorax[:-1] * wave))) % 360
    out = {"pelvis_vertical": 1e3 * np.ptp(y), "pelvis_top_at": 100 * ((-phase) % 0.5)}
    out |= {"pelvis_lateral": 1e3 * np.ptp(lateral), "pelvis_lateral_at": 2.0 * np.argmax(lateral)}
    out |= {
        "ripple": np.ptp(v) / v.mean(),
        "pelvis_yaw": np.ptp(pelvis),
        "thorax_yaw": np.ptp(thorax),
    }
    return out | {
        "pelvis_roll": np.ptp(over_cycle(c[f"pelvis_roll{k.side}"], k)),
        "thorax_trails": trail,
    }


def _width(walk: Walk, found: list[Cycle]) -> float:
    """Distance of the other foot's 30 % point from the line through two successive own ones, mm."""
    at = {0: [], 1: []}
    for k in found:
        t = k.start + round(0.3 * (k.end - k.start))
        at[k.side].append((t, walk.world[t, 3 + 4 * k.side][[0, 2]]))
    widths = []
    for s in (0, 1):
        for (t0, a), (t1, b) in zip(at[s][:-1], at[s][1:], strict=True):
            line = (b - a) / np.linalg.norm(b - a)
            widths += [abs((p - a) @ [line[1], -line[0]]) for t, p in at[1 - s] if t0 < t < t1]
    return float(1e3 * np.mean(widths)) if widths else float("nan")


def _variation(walk: Walk, found: list[Cycle], rows: list[dict], c: dict) -> dict[str, float]:
    """Variation between cycles, with sides centred separately, and the difference of the sides."""

    def spread(name):
        return [
            np.mean([np.std([over_cycle(c[f"{name}{s}"], k) for k in found if k.side == s], 0)])
            for s in (0, 1)
        ]

    def split(values):
        return [
            np.array([v for v, k in zip(values, found, strict=True) if k.side == s]) for s in (0, 1)
        ]

    time = split([(k.other_strike - k.start) / walk.fps for k in found])
    foot = walk.world[:, [3, 7]][..., [0, 2]]
    length = split([np.linalg.norm(foot[k.end, k.side] - foot[k.start, k.side]) / 2 for k in found])
    out = {
        "step_time_sd": np.mean([t.std() for t in time if len(t)]),
        "step_length_sd": 1e3 * np.mean([x.std() for x in length if len(x)]),
    }
    if all(len(t) for t in time):
        out["asymmetry_time"] = abs(time[0].mean() - time[1].mean()) / np.mean(
            [t.mean() for t in time]
        )
    out |= {
        f"sd_{n}": float(np.mean(spread(n)))
        for n in ("thigh", "knee", "hand")
        if all(len(t) for t in time)
    }
    return {k: float(v) for k, v in out.items()}


def _kinematics(walk: Walk) -> dict[str, float]:
    """Jerk, jerk over acceleration, power below 2 and 4 Hz, PCA components."""
    p, fps = walk.world, walk.fps
    jerk = np.linalg.norm(np.diff(p, 3, axis=0), axis=-1).mean() * fps**3
    acceleration = np.linalg.norm(np.diff(p, 2, axis=0), axis=-1).mean() * fps**2
    local = _root_frame(walk)
    velocity = np.diff(local, axis=0) * fps
    f, power = welch(velocity, fps, "hann", min(len(velocity), round(4 * fps)), axis=0)
    power = power.sum(1)
    flat = local - local.mean(0)
    share = np.cumsum(np.linalg.svd(flat, compute_uv=False) ** 2)
    need = {f"pca{q}": int(np.searchsorted(share / share[-1], q / 100) + 1) for q in (90, 95, 99)}
    below = {f"power{h}": float(power[f <= h].sum() / power.sum()) for h in (2, 4)}
    return {
        "jerk": float(jerk),
        "jerk_over_acceleration": float(jerk / acceleration),
        **below,
        **need,
    }


def _root_frame(walk: Walk) -> np.ndarray:
    """Joints minus hips, facing removed, (T, 63)."""
    p = walk.world - walk.world[:, :1]
    forward = walk.facing[:, None]
    left = np.stack([walk.facing[:, 1], -walk.facing[:, 0]], -1)[:, None]
    x = (p[..., [0, 2]] * left).sum(-1)
    z = (p[..., [0, 2]] * forward).sum(-1)
    return np.stack([x, p[..., 1], z], -1).reshape(len(p), -1)
