"""What somebody types, or a page sends: it is used, or refused in this course's words."""

import json

import numpy as np
import pytest
from fuzzing import bounded
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from synthetic_walk import walk

from motiondiff_edu._commands.control_words import ControlError, parse
from motiondiff_edu.conditions.text import TextError, read_words
from motiondiff_edu.widgets.editor import Editor
from motiondiff_edu.widgets.player import Look, Player

VOCABULARY = ("forward", "jump", "kick", "left", "the", "then", "three", "twice", "walk", "wave")
WORDS = st.lists(
    st.sampled_from((*VOCABULARY, "walks", "5", "strolls", "<b>", "²", "é")) | st.text()
)


@given(text=WORDS.map(" ".join) | st.text())
def test_texts(text):
    with bounded():
        try:
            found = read_words(text, VOCABULARY)
        except TextError as error:
            assert len(str(error)) < 1500
        else:
            assert found.words and set(found.words) <= set(VOCABULARY)


PARTS = st.sampled_from(
    ("3s", "1.2", "s", ";", "turn", "left", "-1", "1e400", "nan", "9" * 400, "²s")
)


@given(words=st.lists(PARTS).map(" ".join) | st.text())
def test_controls(words):
    with bounded():
        try:
            segments = parse(words)
        except ControlError:
            return
    assert np.isfinite(segments).all() and all(0 < segment[0] <= 3600 for segment in segments)


FIGURES = arrays(
    st.sampled_from((np.float64, np.float32, np.int64, np.complex64)),
    array_shapes(min_dims=2, max_dims=4, min_side=0, max_side=5) | st.just((3, 21, 3)),
)
NUMBERS = st.integers() | st.floats() | st.none()
LOOKS = st.fixed_dictionaries(
    {},
    optional={
        "parents": st.lists(st.integers(-2, 5), max_size=5),
        "height": NUMBERS,
        "layout": st.sampled_from(("side", "together", "above")),
        "offset": st.tuples(st.floats(), st.floats()),
    },
)
EXTRAS = st.fixed_dictionaries(
    {},
    optional={
        "fps": NUMBERS,
        "past": st.integers() | st.none(),
        "labels": st.text(max_size=5) | st.lists(st.text(max_size=5), max_size=3) | st.integers(),
        "path": arrays(np.float64, array_shapes(max_dims=3, max_side=3)),
        "contacts": arrays(np.bool_, array_shapes(max_dims=3, max_side=3)),
        "audio": arrays(np.float64, array_shapes(max_dims=2, max_side=5)),
    },
)


@pytest.mark.filterwarnings("ignore")
@given(figures=FIGURES, look=LOOKS, extras=EXTRAS)
def test_players(figures, look, extras):
    with bounded():
        try:
            player = Player(figures, look=Look(**look), **extras)
        except (ValueError, TypeError) as error:  # TypeError: what Python says of a wrong type
            assert 0 < len(str(error)) < 1500
            return
        page = player.page()
        assert "NaN" not in json.dumps(player.scene, allow_nan=False) and len(page) > 1000


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=8,
)
KNOWN = st.integers(-2, 13) | VALUES
MESSAGES = st.fixed_dictionaries(
    {"do": st.sampled_from(("toggle", "drag", "keep", "generate", "undo", "reset", "ping", "fly")),
     "number": st.integers(0, 99)},
    optional={"frame": KNOWN, "joint": KNOWN, "grip": KNOWN, "after": KNOWN, "chosen": KNOWN,
              "count": KNOWN, "resample": KNOWN, "part": VALUES | st.just("legs"),
              "by": st.tuples(*[st.floats(-1, 1)] * 3).map(list) | VALUES},
)  # fmt: skip
MOTION = walk(frames=12)[0]


@pytest.mark.filterwarnings("ignore")
@given(messages=st.lists(MESSAGES, min_size=1, max_size=5))
def test_messages_to_the_editor(messages):
    editor = Editor(MOTION, make=lambda *a, **k: MOTION[None])
    with bounded():
        for message in messages:
            editor._receive(editor, message, [])
    assert editor.positions.shape == MOTION.shape and np.isfinite(editor.positions).all()
    assert json.dumps(editor.state, allow_nan=False)
