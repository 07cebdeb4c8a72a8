"""Each part of the command calls what measures it, with arguments that it takes."""

from unittest import mock

import pytest

from tools.results import __main__ as command
from tools.results.__main__ import PARTS, SWEEPS, Context

CALLED = {  # part: where its function is, and its name
    **{name: (command.dances, "dance_records") for name in command.dances.DANCES},
    "footsteps": (command, "footstep_records"),
    "dance-data": (command.dances, "data_records"),
    "attention": (command, "attention_records"),
    "dance-time": (command, "time_records"),
    "course": (command, "course_records"),
    "mend": (command.mend, "records"),
    "mend-both": (command.both, "both_records"),
    "inbetween": (command.inbetween, "inbetween_records"),
    "words": (command.words, "word_records"),
    "dance-ways": (command.dances, "way_records"),
    "ear": (command, "hearing_records"),
    "recordings": (command.continuations, "recorded_records"),
    "recordings-reconstructions": (command.reconstructions, "reconstruction_records"),
    "recordings-inbetweens": (command.recorded_inbetweens, "inbetween_records"),
    "real-music": (command.real_music, "music_records"),
    "course-shown": (command, "shown_records"),
    "gate": (command.gate, "gate_records"),
    "files": (command.files, "file_records"),
    "collect": (command, "collect_records"),
    "words-free": (command.free, "free_records"),
    "eye": (command.eyes, "eye_records"),
    "eye-recordings": (command.eyes, "recorded_records"),
}


@pytest.fixture
def context(tmp_path, monkeypatch):
    """No network is loaded, and no picture is drawn."""
    monkeypatch.setattr(Context, "performer", lambda self, name: (name, "digest"))
    monkeypatch.setattr(Context, "walker", lambda self: ("walker", "digest", self.recorded))
    monkeypatch.setattr(command.dances.Stage, "dancer", lambda self, name: name)
    monkeypatch.setattr(command.persons, "person_records", lambda *given: [])
    monkeypatch.setattr(command, "footstep_curves", lambda curves: None)
    monkeypatch.setattr(command, "attention_picture", lambda stage: None)
    monkeypatch.setattr(command, "save", lambda figure, path: None)
    return Context(True, {}, tmp_path, tmp_path / "runs")


@pytest.mark.parametrize("name", PARTS)
def test_a_part_calls_its_function_with_what_it_takes(name, context):
    module, function = CALLED[name]
    found = ([{"name": name}], {}) if name == "footsteps" else [{"name": name}]
    with mock.patch.object(module, function, autospec=True, return_value=found) as called:
        assert command.records_of(name, context, {}, "a command") == [{"name": name}]
    (given,) = called.call_args_list
    assert "a command" in (*given.args, *given.kwargs.values())


@pytest.mark.parametrize("name", SWEEPS)
def test_a_sweep_is_made_with_its_variants(name, context):
    with mock.patch.object(command.departures, "trials", return_value=None):
        sweep = SWEEPS[name].sweep(context, context.runs)
    assert sweep.name == name and sweep.variants is SWEEPS[name].variants
    for one in sweep.variants.values():
        assert set(one.rivals.values()) <= set(sweep.variants)
    assert {"{}" in pattern for pattern in sweep.differences} <= {True}
