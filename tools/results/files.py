"""Files of others: reported ones that end as they should, and what reading costs.

looked.reports_right        of reported files (`reports`), the share that is read right, or refused
                            or doubted in words that name the fault
looked.sound_seconds_lost   seconds of its sounds that are not heard
looked.read_share           of all real files, the share that is read, or refused in words
looked.read_over_parsing    time of reading the motions, over that of parsing their BVH alone
"""

import re
import shutil
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
import numpy as np
from nbconvert import HTMLExporter
from nbconvert.preprocessors import ExecutePreprocessor

import motiondiff_edu as md
from motiondiff_edu.conditions.audio_files import read_audio, samples_of
from motiondiff_edu.course.export import still_alive
from motiondiff_edu.motion.formats.bvh import read_bvh
from motiondiff_edu.motion.formats.bvh.frames import rate
from motiondiff_edu.motion.motion import Motion
from motiondiff_edu.motion.skeleton import joint_index
from motiondiff_edu.recipes.recordings import recording_files

from .walks.scores import Measure, measure_of

HEAD, TOES = 12, [4, 8]
MOTIONS, SOUNDS = (
    (".bvh", ".npz", ".npy", ".pkl"),
    (".wav", ".ogg", ".mp3", ".flac", ".aiff", ".au"),
)
SECONDS_OF = {
    "22_vbr_no_xing.mp3": 60, "23_two_mp3_joined.mp3": 80, "25_vbr_false_cut_off.mp3": 41,
    "26_cbr_cover_false_cut_off.mp3": 40, "27_gsm.wav": 6, "28_unfinished_header.wav": 6,
}  # fmt: skip


def answered(call: Callable[[], object]) -> tuple[object, str]:
    """What a call gives (None for an error that is meant for the user), and all that it says."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            made = call()
        except (ValueError, OSError) as error:
            return None, str(error)
    return made, " ".join(str(one.message) for one in said)


def height(motion: Motion) -> float:
    """How far the head is above the toes, in metres."""
    return float(np.median(motion.positions[:, HEAD, 1] - motion.positions[:, TOES, 1].mean(1)))


def told(pattern: str, least: float = -9, most: float = 9) -> Callable[[Path, object, str], bool]:
    """A file is right if this is said, and the head, if it is read, so high above the toes."""

    def right(path: Path, made, said: str) -> bool:
        stands = made is None or least < height(made) < most
        return stands and bool(re.search(pattern, said))

    return right


def refused(pattern: str) -> Callable[[Path, object, str], bool]:
    return lambda path, made, said: made is None and bool(re.search(pattern, said))


def same_as(other: str, said_too: str = "$", far: float = 0.02) -> Callable:
    """A file is right if it is the same motion as another, and this is said of it."""

    def right(path: Path, made, said: str) -> bool:
        if made is None or not re.match(said_too, said):
            return False
        usual = md.read_motion(path.with_name(other)).positions
        return len(made) == len(usual) and float(np.abs(made.positions - usual).max()) < far

    return right


BASE, MDM = "00_base.bvh", "14_mdm_22_3_T.npy"
BOTH_NAMED = "the rest pose .*says? that \\+y is up, but the figure says"
EXPECTED = {
    "01_lying_on_back.bvh": told(BOTH_NAMED, most=0.3),
    "02_face_down.bvh": told(BOTH_NAMED, most=0.3),
    "03_handstand.bvh": told("rest pose .*say that \\+y is up, but the figure says -y", most=-1.3),
    "05_dog_with_human_names.bvh": told("at a right angle in all frames"),
    "06_root_100x.bvh": same_as(BASE, ".*two units: the path was multiplied by 0.01"),
    "08_mediapipe_hip_centred.npz": told("no path of its own", least=1.3),
    "09_rotations_only.bvh": told("no path of its own", least=1.3),
    "10_joints_z_up.npy": told("^10_joints_z_up.npy: z up: .*turned", least=1.3),
    "11_joints_upside_down.npy": told("^11_joints_upside_down.npy: -y up: .*turned", least=1.3),
    "13_joints_cm.npy": same_as(MDM, ".*are in centimetres; they are read in metres"),
    MDM: told("^$", least=1.3),
    "15_mdm_1_22_3_T.npy": same_as(MDM),
    "16_mdm_results.npy": refused("take a motion out of it: .*numpy.save"),
    "17_edge.pkl": refused("all joints of a frame are in one place"),
    "18_npz_22_without_names.npz": same_as(MDM),
    "19_amass.npz": refused("joint angles .*smplx.*numpy.savez"),
    "20_kimodo.npz": same_as(MDM),
    "21_smplx_55.npy": same_as(MDM),
    "31_tpose_held_2s_then_cut.bvh": same_as(BASE, ".*frames 0 to 59 are a calibration pose"),
    "32_EndSite_one_word.bvh": same_as(BASE),
    "33_ctrl_z.bvh": same_as(BASE),
    "34_two_people_one_root.bvh": refused("2 figures: their joints begin with A_ and B_"),
    "35_zero_positions.bvh": same_as(BASE),
    "39_makehuman.bvh": same_as(BASE, far=0.15),  # it has no joint between the hips
    "40_mmd_japanese.bvh": refused("no joint found for Hips.*mapping="),
}


SENTENCES = {  # of report 37, with the hands that wave
    "a person walks backwards and waves with both hands": ("Left", "Right"),
    "walks backwards while waving with the left hand": ("Left",),
}


def reported(folder: Path, sounds: dict[str, tuple[float, str]]) -> dict[str, bool]:
    """Of each report, whether it ends as it should.  `sounds` as `heard` gives them."""
    right = {}
    for name, expected in EXPECTED.items():
        path = folder / name
        right[name] = expected(path, *answered(lambda path=path: md.read_motion(path)))
    right |= {name: not missing and not said for name, (missing, said) in sounds.items()}
    samples = np.zeros(6 * 22_050)
    right["29"] = "sample_rate" in answered(lambda: samples_of(samples))[1]
    right["30"] = players_on_the_page(folder) == 2
    right["36"] = [rate(seconds) for seconds in (0.0333, 0.0083, 0.033)] == [30, 120, 30]
    right["37"] = all(
        shown_or_told(text, hands, seed) for text, hands in SENTENCES.items() for seed in range(3)
    )
    right["38"] = "is an address: download" in answered(
        lambda: md.read_motion("https://example.org/walk.bvh"))[1]  # fmt: skip
    return right


def heard(folder: Path) -> dict[str, tuple[float, str]]:
    """Of each reported sound, the seconds that are not heard, and what was said.

    A twentieth of a second is the padding of its encoder, and counts as 0.
    """
    found = {}
    for name, seconds in SECONDS_OF.items():
        samples, said = answered(lambda name=name: read_audio(folder / name))
        missing = seconds - (0 if samples is None else len(samples) / 16_000)
        found[name] = (missing if missing > 0.05 else 0.0, said)
    return found


def players_on_the_page(folder: Path) -> int:
    """How many figures move on the page of the notebook of report 30, run and exported."""
    notebook = nbformat.read(folder / "30_small.ipynb", as_version=4)
    with TemporaryDirectory() as place:
        shutil.copy(folder / BASE, place)
        run = ExecutePreprocessor(timeout=600, kernel_name="python3")
        run.preprocess(notebook, {"metadata": {"path": place}})
    still_alive(notebook)
    return HTMLExporter().from_notebook_node(notebook)[0].count("<iframe")


def shown_or_told(text: str, hands: tuple[str, ...], seed: int) -> bool:
    """Whether a figure walks back and holds these hands over their shoulders, or a warning says
    what is not to be seen."""
    made, said = answered(lambda: md.load("mover").act(text, seed=seed))
    if not isinstance(made, Motion) or "; but " in said:
        return bool(said)
    points = made.positions
    up = [
        points[:, joint_index(f"{side}Hand"), 1] > points[:, joint_index(f"{side}Arm"), 1]
        for side in hands
    ]
    back = points[0, 0, 2] - points[-1, 0, 2]  # metres; it begins facing z
    return bool(back > 1 and np.all(np.mean(up, axis=1) > 0.5))


def in_words(path: Path) -> bool:
    """Whether a file is read, or refused by an error that is meant for its owner."""
    try:
        answered(lambda: (read_audio if path.suffix.lower() in SOUNDS else md.read_motion)(path))
    except Exception:  # whatever else comes is what this counts
        return False
    return True


def times(path: Path) -> tuple[float, float]:
    """CPU-seconds of reading a BVH file, and of parsing it alone: the least of three."""
    both = []
    for read in (md.read_motion, read_bvh):
        tried = []
        for _ in range(3):
            began = time.process_time()
            answered(lambda read=read: read(path))
            tried.append(time.process_time() - began)
        both.append(min(tried))
    return both[0], both[1]


def file_records(command: str, quick: bool) -> list[dict]:
    """All records."""
    root = Path(recording_files()[0]).parents[1]
    reports = root / "reports"
    every = [p for p in sorted(root.rglob("*")) if p.suffix.lower() in (*MOTIONS, *SOUNDS)]
    every = every[:: 10 if quick else 1]
    sounds = heard(reports)
    right = reported(reports, sounds)
    for name in (name for name, one in right.items() if not one):
        print(f"not as it should be: {name}")
    whole = [
        path for path in every if path.parent.name in ("bvh", "cmu30") and path.suffix == ".bvh"
    ]
    lost = [missing for missing, _ in sounds.values()]
    read = [path.name in sounds or in_words(path) for path in every]
    spent = np.array([times(path) for path in whole]).T
    found: list[Measure] = [
        measure_of("reports_right", "share", np.mean, np.array(list(right.values()), float)),
        measure_of("sound_seconds_lost", "s", np.sum, np.array(lost)),
        measure_of("read_share", "share", np.mean, np.array(read, float)),
        measure_of("read_over_parsing", "x", lambda a, b: a.sum() / b.sum(), *spent),
    ]
    about = {"reports": len(right), "files": len(every)}
    return [one.as_record("looked.", about, command) for one in found]
