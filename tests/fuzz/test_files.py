"""Damaged and hostile files: each is read, or refused in this course's words, and never hangs.

Hypothesis draws the damage, and finds the smallest that goes wrong.
"""

import io
import pickle
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import soundfile
import torch
from bvh_text import SMALL
from foreign_walk import foreign
from fuzzing import bounded, damaged
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from safetensors import safe_open
from safetensors.torch import load_file, save_file

from motiondiff_edu.conditions.audio_files import AudioError, read_audio
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.motion.formats.aist import AistError, read_keypoints
from motiondiff_edu.motion.formats.bvh import BvhError, read_bvh
from motiondiff_edu.motion.formats.files import read_motion
from motiondiff_edu.motion.motion import Motion, MotionError
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained import checkpoints, weights_file

BVH = (
    b"{", b"}", b"JOINT a", b"ROOT b\n", b"End Site", b"OFFSET 1e9 0 0", b"CHANNELS 3", b"MOTION",
    b"Frames: 99999999999", b"nan", b"-", "é²".encode(), b"1e308 ", b"\n", b"\t", b"0 1 ",
)  # fmt: skip


def read_or_refused(read: Callable, path: Path, error: type[Exception]) -> object:
    """What is read, or None if it is refused with the file's name in a message of a sane length."""
    with bounded(), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            return read(path)
        except error as found:
            words = str(found)
            assert path.name in words and len(words) < 1500, words
            return None


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@given(content=damaged(SMALL.encode(), BVH))
def test_bvh(folder, content):
    (folder / "take.bvh").write_bytes(content)
    found = read_or_refused(read_bvh, folder / "take.bvh", BvhError)
    if found is not None:
        assert np.isfinite(found.world_positions()).all()


@pytest.fixture(scope="module")
def walk_file(folder) -> bytes:
    return foreign(folder / "good.bvh", frames=41, fps=30).read_bytes()


@given(data=st.data())
def test_bvh_of_a_figure(folder, walk_file, data):
    (folder / "walk.bvh").write_bytes(data.draw(damaged(walk_file, BVH)))
    motion = read_or_refused(read_motion, folder / "walk.bvh", BvhError)
    if motion is not None:
        assert np.isfinite(motion.positions).all() and motion.positions.shape[1:] == (21, 3)


def sounds() -> dict[str, bytes]:
    """A second of sound in four formats."""
    tone = 0.3 * np.sin(np.arange(24_000) / 9) + RNG.normal(0, 0.01, 24_000)
    made = {}
    for kind, subtype in (
        ("WAV", "PCM_16"),
        ("FLAC", "PCM_16"),
        ("OGG", "VORBIS"),
        ("AIFF", "PCM_24"),
    ):
        file = io.BytesIO()
        soundfile.write(file, tone, 16_000, format=kind, subtype=subtype)
        made[kind] = file.getvalue()
    return made


RNG = np.random.default_rng(0)
SOUNDS = sounds()


@given(data=st.data(), kind=st.sampled_from(sorted(SOUNDS)))
def test_sound(folder, kind, data):
    # most of a file is samples: the damage goes to the header as well
    head = data.draw(damaged(SOUNDS[kind][:120]))
    rest = SOUNDS[kind][120:]
    content = head + rest if data.draw(st.booleans()) else data.draw(damaged(SOUNDS[kind]))
    (folder / "song.wav").write_bytes(content)
    audio = read_or_refused(read_audio, folder / "song.wav", AudioError)
    if audio is not None:
        assert torch.isfinite(audio).all() and 1 <= len(audio) / 16_000 <= 3600


def npz(**parts: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.savez(file, **parts)
    return file.getvalue()


GOOD = Motion(RNG.normal(size=(6, 21, 3)), 20.0)
NPZ = npz(
    positions=GOOD.positions, fps=20.0, names=GOOD.skeleton.names, parents=GOOD.skeleton.parents
)


_packed = io.BytesIO()
np.savez_compressed(_packed, positions=GOOD.positions, fps=20.0)
MARKS = (b"PK\x03\x04", b"positions.npy")


@given(content=st.one_of(damaged(NPZ, MARKS), damaged(_packed.getvalue(), MARKS)))
def test_npz(folder, content):
    (folder / "motion.npz").write_bytes(content)
    read_or_refused(read_motion, folder / "motion.npz", MotionError)


ANYTHING = arrays(
    st.sampled_from((np.float64, np.float16, np.int64, np.uint8, np.bool_, np.complex128, "U3")),
    array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=22),
)
NAMES = (
    "positions", "fps", "names", "parents", "root", "contacts", "audio", "sample_rate", "poses",
    "control", "source", "format",
)  # fmt: skip


@given(parts=st.dictionaries(st.sampled_from(NAMES), ANYTHING, max_size=5), whole=st.booleans())
def test_npz_of_other_arrays(folder, parts, whole):
    good = {"positions": GOOD.positions, "fps": np.array(20.0)} if whole else {}
    (folder / "arrays.npz").write_bytes(npz(**good | parts))
    motion = read_or_refused(read_motion, folder / "arrays.npz", MotionError)
    if motion is not None:
        assert motion.positions.ndim == 3 and 0 < motion.fps < np.inf


PICKLE = pickle.dumps({"keypoints3d_optim": RNG.uniform(80, 240, (4, 17, 3))}, protocol=4)
HOSTILE = (b"cos\nsystem\n(S'touch ran'\ntR.", b"]" * 500, b"(lp0\n", b"\x8c\x05numpy", b"R", b"c")


@given(content=damaged(PICKLE, HOSTILE))
def test_pickles(folder, content):
    (folder / "dance.pkl").write_bytes(content)
    found = read_or_refused(read_keypoints, folder / "dance.pkl", AistError)
    assert not Path("ran").exists()
    if found is not None:
        assert found.positions.shape[1:] == (17, 3)


@pytest.fixture(scope="module")
def weights(folder) -> Path:
    torch.manual_seed(1)
    model = MoDiff(MoDiffConfig(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24)).eval()
    scalers = [Scaler(torch.zeros(n), torch.ones(n)) for n in (63, 3)]
    walker = Walker(model, linear_schedule(6, 0.2, 0.95), *scalers, {"name": "tiny"})
    return checkpoints.save(walker, folder / "good.safetensors")


@given(data=st.data())
def test_weights(folder, weights, data):
    content = weights.read_bytes()
    start = data.draw(st.sampled_from((0, 0, len(content) // 2)))
    part = data.draw(damaged(content[start : start + 2000], (b'"T_h": 9', b"99999999", b"F32")))
    path = folder / "bad.safetensors"
    path.write_bytes(content[:start] + part + content[start + 2000 :])
    read_or_refused(checkpoints.load, path, checkpoints.CheckpointError)


SETTINGS = st.sampled_from(
    ("T_h", "T_p", "S", "width", "heads", "hidden", "dropout", "target", "D", "x")
)
VALUES = (
    st.integers() | st.integers(-3, 9000) | st.floats() | st.text(max_size=5) | st.none()
    | st.lists(st.integers(-5, 50), max_size=3)
)  # fmt: skip


@given(changes=st.dictionaries(SETTINGS, VALUES, min_size=1, max_size=3))
def test_settings_with_a_right_checksum(folder, weights, changes):
    path = folder / "set.safetensors"
    with safe_open(weights, "pt") as file:
        metadata = file.metadata()
    config = weights_file.json.loads(metadata["config"]) | changes
    metadata |= {"config": weights_file.json.dumps(config)}
    tensors = load_file(weights)
    save_file(tensors, path, metadata | weights_file._digests(tensors, metadata))
    read_or_refused(checkpoints.load, path, checkpoints.CheckpointError)
