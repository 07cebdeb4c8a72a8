"""Are synthetic walks like real ones?

The table compares many of our walkers with the range of real clips.

python -m data_synth.walking.acceptance [--walks 24]

It prints this table, and then the data's own measures and limits, which README.md shows.
"""

import argparse
from dataclasses import replace

import numpy as np

from .gait_statistics import statistics
from .own_measures import limits, own_measures
from .styles import STYLES, person
from .walks import walk

# name -> (lowest, highest) mean of 8 real neutral walks of 0.95-1.6 m/s, 20 frames/s
NEUTRAL = {
    "slip": (0.35, 2.7),
    "toe_below": (-5, 0),
    "toe_lift": (78, 111),
    "clearance": (13, 25),
    "ankle_lift": (133, 176),
    "cadence_off_fit": (-9.6, 9.6),
    "step_length_off_fit": (-0.05, 0.05),
    "stance": (0.59, 0.67),
    "double_support": (0.18, 0.34),
    "flight": (0, 0),
    "step_width": (12, 145),
    "pelvis_vertical": (17, 52),
    "pelvis_top_at": (28, 38),
    "pelvis_lateral": (32, 71),
    "pelvis_lateral_at": (18, 45),
    "ripple": (0.22, 0.54),
    "pelvis_yaw": (13, 23),
    "pelvis_roll": (3, 11),
    "thorax_yaw": (4, 21),
    "thorax_trails": (30, 140),
    "lean": (-6, 8),
    "lean_swing": (2.3, 4),
    "head_vertical": (17, 49),
    "head_lateral": (26, 66),
    "head_pitch": (2.6, 7.8),
    "arm_swing": (25, 65),
    "hand_thigh_r": (0.75, 1.0),
    "elbow": (14, 30),
    "elbow_range": (21, 61),
    "thigh_range": (35, 59),
    "knee_peak": (64, 77),
    "knee_rise": (7, 26),
    "knee_fall": (9, 33),
    "knee_min": (0, 16),
    "step_time_sd": (0.01, 0.031),
    "step_length_sd": (6, 30),
    "asymmetry_time": (0.01, 0.12),
    "sd_thigh": (1.0, 1.5),
    "sd_knee": (1.8, 2.8),
    "sd_hand": (1.3, 4.2),
    "jerk": (49, 160),
    "jerk_over_acceleration": (12, 22),
    "power2": (0.84, 0.93),
    "power4": (0.98, 0.99),
    "pca90": (1, 3),
    "pca95": (3, 4),
    "pca99": (4, 8),
}
# our means that lie outside, and why; the data card says more
OUTSIDE = {
    "slip": "planted toes are exactly still by construction",
    "sd_thigh": (
        "cadence drifts on purpose, so that continuations part; "
        "our clips are longer than the real ones"
    ),
    "pca95": "fewer independent movements than a person has",
    "run jerk": "two real runs, both captured with noise; ours are smooth",
    "run power2": "two real runs, both captured with noise; ours are smooth",
}
# two real runs, 2.6-3.6 m/s: indicative only
RUN = {
    "cadence": (150, 155),
    "step_length": (1.04, 1.43),
    "flight": (0.13, 0.40),
    "stance": (0.31, 0.44),
    "knee_peak": (112, 132),
    "pelvis_vertical": (128, 149),
    "elbow": (90, 118),
    "arm_swing": (61, 69),
    "thigh_range": (62, 64),
    "lean": (2, 11),
    "jerk": (290, 470),
    "power2": (0.68, 0.75),
    "knee_min": (10, 31),
}


def steady_walk(speed: float, seed: int, seconds: float = 13.0) -> dict[str, float]:
    """Statistics of a neutral walker who goes straight at one speed.

    It has no arm or head behaviours.
    """
    who = replace(person(STYLES["neutral"], np.random.default_rng([seed, 9])), behaviours=0.0)
    control = np.tile([speed, 0.0, 0.0], (round(20 * seconds), 1))
    s = statistics(walk(control, seed, who).world())
    s["cadence_off_fit"] = s["cadence"] - (74 + 27 * s["v"])
    s["step_length_off_fit"] = s["step_length"] - (0.256 + 0.347 * s["v"])
    return s


def table(rows: list[dict[str, float]], ranges: dict[str, tuple[float, float]]) -> list[tuple]:
    """Rows that compare our walks with the real range.

    (name, mean, smallest, largest of ours, lowest, highest real, share of walkers inside the range
    +- 10 %).
    """
    lines = []
    for name, (low, high) in ranges.items():
        values = np.array([r[name] for r in rows if np.isfinite(r.get(name, np.nan))])
        slack = 0.1 * (high - low)
        inside = np.mean((values >= low - slack - 1e-9) & (values <= high + slack + 1e-9))
        lines.append((name, values.mean(), values.min(), values.max(), low, high, float(inside)))
    return lines


def acceptance(walks: int = 24, runs: int = 8) -> tuple[list[tuple], list[tuple]]:
    """The tables of neutral walks (speeds spread over 0.95-1.6 m/s) and of runs (2.6-3.0 m/s)."""
    walked = [steady_walk(v, k) for k, v in enumerate(np.linspace(0.97, 1.58, walks))]
    ran = [steady_walk(v, 100 + k) for k, v in enumerate(np.linspace(2.6, 3.0, runs))]
    return table(walked, NEUTRAL), table(ran, RUN)


def means_outside(walked: list[tuple], ran: list[tuple]) -> set[str]:
    """Names of the statistics whose mean over walkers is outside the real range.

    "run ..." for those of running.
    """
    lines = [("", line) for line in walked] + [("run ", line) for line in ran]
    return {
        prefix + line[0]
        for prefix, line in lines
        if not line[4] - 1e-9 <= line[1] <= line[5] + 1e-9
    }


def _mark(mean: float, low: float, high: float) -> str:
    return "" if low - 1e-9 <= mean <= high + 1e-9 else "**mean out** "


def show(lines: list[tuple]) -> str:
    """The table as Markdown."""
    head = (
        "| statistic | ours: mean | min | max | real: "
        "low | high | inside |\n|---|---|---|---|---|---|---|\n"
    )
    return head + "".join(
        f"| {n} | {m:.3g} | {a:.3g} | {b:.3g} | {lo:.3g} | {hi:.3g} | {_mark(m, lo, hi)}{i:.0%} |\n"
        for n, m, a, b, lo, hi, i in lines
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m data_synth.walking.acceptance")
    parser.add_argument("--walks", type=int, default=24)
    for part in acceptance(parser.parse_args().walks):
        print(show(part))
    print("\n".join(f"{name}: {value:.3g}" for name, value in (own_measures() | limits()).items()))
