"""Weights on disk.

They come back as they were, and whatever is damaged or foreign is refused with the reason.
"""

import json
import pickle
import warnings
from dataclasses import replace
from pathlib import Path

import pytest
import torch
from safetensors import safe_open
from safetensors.torch import load_file, save_file

from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained import checkpoints, weights_file
from motiondiff_edu.pretrained.checkpoints import CheckpointError, available, load, save


def tiny_walker() -> Walker:
    torch.manual_seed(1)
    model = MoDiff(MoDiffConfig(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24))
    pose = Scaler(torch.linspace(-2, 3, 63), torch.linspace(0.1, 0.6, 63))
    control = Scaler(torch.tensor([1.0, 0.1, -0.2]), torch.tensor([0.5, 0.2, 0.8]))
    return Walker(
        model.eval(), linear_schedule(6, 0.2, 0.95), pose, control, {"name": "tiny", "steps": 12}
    )


@pytest.fixture()
def saved(tmp_path: Path) -> Path:
    return save(tiny_walker(), tmp_path / "tiny.safetensors")


def settings_of(path: Path) -> dict[str, str]:
    """The metadata of a weights file."""
    with safe_open(path, "pt") as file:
        return file.metadata()


def rewrite(path: Path, change, metadata=None) -> None:
    """Change the tensors of a weights file.

    The metadata stay (unless others are given), the checksums are right.
    """
    metadata = settings_of(path) if metadata is None else metadata
    tensors = load_file(path)
    change(tensors)
    save_file(tensors, path, metadata | weights_file._digests(tensors, metadata))


def test_the_card_never_overwrites_the_weights(tmp_path: Path):
    with pytest.raises(ValueError, match="to a file .safetensors, not to 'walker.json'"):
        save(tiny_walker(), tmp_path / "walker.json")
    assert not list(tmp_path.iterdir())


def test_round_trip_in_full_precision_is_exact(tmp_path: Path):
    walker = tiny_walker()
    back = load(path := save(walker, tmp_path / "tiny.safetensors", bits=32))
    assert checkpoints.bits_of(path) == 32
    assert back.config == walker.config and back.card == walker.card
    for (name, old), new in zip(
        walker.model.state_dict().items(), back.model.state_dict().values(), strict=True
    ):
        assert torch.equal(old, new), name
    assert torch.equal(back.schedule.alpha_bar, walker.schedule.alpha_bar)
    assert back.schedule.name == walker.schedule.name
    for name in ("pose_scaler", "control_scaler"):
        assert torch.equal(getattr(back, name).mean, getattr(walker, name).mean)
        assert torch.equal(getattr(back, name).std, getattr(walker, name).std)
    assert not back.model.training and not any(p.requires_grad for p in back.model.parameters())


@pytest.mark.parametrize("bits", [8, 16, 32])
def test_whole_numbers_come_back_exactly(tmp_path: Path, monkeypatch, bits: int):
    class Counting(MoDiff):
        def __init__(self, config):
            super().__init__(config)
            self.register_buffer("order", torch.arange(100_000, 100_000 + 5000))

    there = checkpoints.networks_of("walker")
    kind = replace(there["MoDiff"], model=Counting)
    monkeypatch.setattr(checkpoints, "networks_of", lambda name: there | {"Counting": kind})
    monkeypatch.setattr(checkpoints, "kind_of", lambda model: kind)
    walker = tiny_walker()
    walker = replace(walker, model=Counting(walker.config).eval())
    back = load(save(walker, tmp_path / "counting.safetensors", bits=bits))
    assert torch.equal(back.model.order, walker.model.order)


def test_weights_beyond_float16_are_refused_before_they_become_infinite(tmp_path: Path):
    walker = tiny_walker()
    with torch.no_grad():
        walker.model.past_in.weight[0, 0] = 1e5
    with pytest.raises(ValueError, match="past_in.weight goes up to 1e.05, beyond float16: pass"):
        save(walker, tmp_path / "large.safetensors")
    assert not list(tmp_path.iterdir())
    back = load(save(walker, tmp_path / "large.safetensors", bits=32))
    assert back.model.past_in.weight[0, 0] == 1e5
    with torch.no_grad():
        walker.model.past_in.bias[0] = 7e4
    with pytest.raises(ValueError, match="past_in.bias goes up to 7e.04, beyond float16"):
        save(walker, tmp_path / "small.safetensors", bits=8)


def test_the_home_folder_may_be_named_by_a_tilde(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    save(tiny_walker(), "~/mine.safetensors")
    assert (tmp_path / "mine.safetensors").exists()
    assert load("~/mine.safetensors").config == tiny_walker().config


def test_a_card_that_is_none_is_refused(saved: Path):
    rewrite(saved, lambda tensors: None, settings_of(saved) | {"card": "[1]"})
    with pytest.raises(CheckpointError, match="the card is a list"):
        load(saved)


def test_in_eight_bits_each_weight_is_off_by_half_a_step_of_its_row_at_most(tmp_path: Path):
    walker = tiny_walker()
    small, usual = (save(walker, tmp_path / f"{bits}.safetensors", bits=bits) for bits in (8, 16))
    back, raw = load(small), load_file(small)
    assert small.stat().st_size < 0.9 * usual.stat().st_size  # vectors and the header do not shrink
    assert [checkpoints.bits_of(path) for path in (small, usual)] == [8, 16]
    matrices = 0
    for (name, old), new in zip(
        walker.model.state_dict().items(), back.model.state_dict().values(), strict=True
    ):
        if old.dim() < 2:
            assert torch.equal(new, old.half().float()), name
            continue
        matrices += 1
        assert raw[f"model.{name}"].dtype == torch.int8
        step = old.flatten(1).abs().amax(1) / 127
        assert ((new - old).flatten(1).abs().amax(1) <= 0.5001 * step).all(), name
        assert torch.allclose(
            new.flatten(1).abs().amax(1), old.flatten(1).abs().amax(1), rtol=1e-5
        ), name
    assert matrices > 10


def test_no_other_number_of_bits_is_taken(tmp_path: Path):
    with pytest.raises(ValueError, match="8, 16 or 32 bits, not 4"):
        save(tiny_walker(), tmp_path / "tiny.safetensors", bits=4)


def test_a_file_in_eight_bits_without_a_scale_is_refused(tmp_path: Path):
    path = save(tiny_walker(), tmp_path / "tiny.safetensors", bits=8)
    rewrite(
        path, lambda tensors: tensors.pop(next(name for name in tensors if name.endswith(".scale")))
    )
    with pytest.raises(CheckpointError, match="disagree"):
        load(path)


def test_shipped_files_are_float16_and_load_as_float32(saved: Path):
    raw, back = load_file(saved), load(saved)
    assert {raw[k].dtype for k in raw if k.startswith("model.")} == {torch.float16}
    assert raw["pose.mean"].dtype == torch.float32 and raw["schedule.beta"].dtype == torch.float64
    for name, old in tiny_walker().model.state_dict().items():
        new = back.model.state_dict()[name]
        assert new.dtype == torch.float32
        assert torch.equal(new, old.half().float())


def test_the_card_lies_beside_it_and_no_temporary_file_stays(saved: Path):
    card = json.loads(saved.with_suffix(".json").read_text())
    assert card["name"] == "tiny" and card["config"]["T_p"] == 3
    assert sorted(p.name for p in saved.parent.iterdir()) == ["tiny.json", "tiny.safetensors"]


def test_shipped_weights_have_their_files_names(saved: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(checkpoints, "FOLDER", saved.parent)
    assert available() == {"tiny": saved}
    assert load("tiny").card["name"] == "tiny"
    assert checkpoints.load(Path("tiny")).card == checkpoints.load("tiny").card
    with pytest.raises(CheckpointError, match="no weights are called 'dancer'; there are: tiny$"):
        load("dancer")


def test_shipped_weights_are_read_once(saved: Path, monkeypatch: pytest.MonkeyPatch):
    reads, opened = [], weights_file._opened
    monkeypatch.setattr(weights_file, "_opened", lambda path: reads.append(path) or opened(path))
    monkeypatch.setattr(checkpoints, "FOLDER", saved.parent)
    first, again = load("tiny"), load("tiny")
    assert isinstance(first, Walker) and reads == [saved]
    with torch.no_grad():  # what one user changes is not another's
        next(first.model.parameters()).add_(1.0)
    first.card["name"] = "changed"
    assert again.card == load("tiny").card != first.card
    for one, other in ((again, load("tiny")), (first, load("tiny"))):
        same = torch.equal(next(one.model.parameters()), next(other.model.parameters()))
        assert same == (one is again)
    save(replace(first, card={"name": "retrained"}), saved)
    assert load("tiny").card["name"] == "retrained" and len(reads) == 2


def test_with_no_weights_at_all_it_says_how_to_make_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(checkpoints, "FOLDER", tmp_path)
    with pytest.raises(CheckpointError, match="none .run make pretrained."):
        load("walker")


def test_a_missing_file(tmp_path: Path):
    with pytest.raises(CheckpointError, match="there is no weights file .*gone.safetensors"):
        load(tmp_path / "gone.safetensors")


@pytest.mark.parametrize("share", [0.0, 0.001, 0.1, 0.9, 0.9999])
def test_a_truncated_file(saved: Path, share: float):
    whole = saved.read_bytes()
    saved.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(
        CheckpointError, match="tiny.safetensors is damaged or not a safetensors file"
    ):
        load(saved)


@pytest.mark.parametrize("place", [0, 3, 9, 40, 200])
def test_flipped_bytes_in_the_header(saved: Path, place: int):
    raw = bytearray(saved.read_bytes())
    raw[place] ^= 0xFF
    saved.write_bytes(raw)
    with pytest.raises(CheckpointError, match="tiny.safetensors"):
        load(saved)


@pytest.mark.parametrize("place", [-1, -500, -5000])
def test_flipped_bytes_in_the_weights(saved: Path, place: int):
    raw = bytearray(saved.read_bytes())
    raw[place] ^= 0x40
    saved.write_bytes(raw)
    with pytest.raises(CheckpointError, match="tiny.safetensors.*damaged"):
        load(saved)


def test_a_foreign_safetensors_file(tmp_path: Path):
    path = tmp_path / "other.safetensors"
    save_file({"encoder.weight": torch.zeros(2, 3), "bias": torch.zeros(3)}, path)
    kinds = "not a walker, dancer, mover or inbetweener of this project"
    with pytest.raises(CheckpointError, match=f"{kinds} .its tensors begin with bias, encoder"):
        load(path)


class Bomb:
    """Unpickling this creates a file."""

    def __init__(self, path: Path):
        self.path = path

    def __reduce__(self):
        return (open, (str(self.path), "w"))


@pytest.mark.parametrize("form", ["pickle", "torch"])
def test_a_pickle_is_refused_and_not_executed(tmp_path: Path, form: str):
    path, mark = tmp_path / "weights.safetensors", tmp_path / "executed"
    if form == "pickle":
        path.write_bytes(pickle.dumps(Bomb(mark)))
    else:
        torch.save({"model": Bomb(mark)}, path)
    with pytest.raises(
        CheckpointError, match="weights.safetensors is damaged or not a safetensors file"
    ):
        load(path)
    assert not mark.exists()
    with warnings.catch_warnings():  # the bomb is real
        warnings.simplefilter("ignore")
        pickle.loads(pickle.dumps(Bomb(mark))).close()
    assert mark.exists()


def test_a_folder_is_not_a_file(tmp_path: Path):
    with pytest.raises(CheckpointError, match="there is no weights file"):
        load(tmp_path)


def test_weights_that_are_not_finite(saved: Path):
    rewrite(saved, lambda tensors: tensors["model.past_in.weight"].view(-1)[5].fill_(torch.nan))
    with pytest.raises(
        CheckpointError, match="model.past_in.weight contains NaN or infinity; its training"
    ):
        load(saved)


@pytest.mark.parametrize("name", ["model.past_in.weight", "pose.std", "schedule.beta"])
def test_a_tensor_that_is_missing_or_has_another_shape(saved: Path, name: str):
    rewrite(saved, lambda tensors: tensors.pop(name))
    with pytest.raises(CheckpointError, match="tiny.safetensors"):
        load(saved)


def test_a_tensor_of_another_size(saved: Path):
    rewrite(saved, lambda tensors: tensors.update({"model.past_in.weight": torch.zeros(16, 62)}))
    with pytest.raises(
        CheckpointError, match="(?s)weights and configuration disagree.*past_in.weight"
    ):
        load(saved)
    save(tiny_walker(), saved)
    rewrite(saved, lambda tensors: tensors.update({"pose.mean": torch.zeros(62)}))
    with pytest.raises(CheckpointError, match="pose.mean has the shape .62,.; it must be .63,."):
        load(saved)


@pytest.mark.parametrize("name", ["sha256", "sha256_settings"])
def test_a_file_without_a_checksum_is_refused(saved: Path, name: str):
    with safe_open(saved, "pt") as file:
        metadata = {k: v for k, v in file.metadata().items() if k != name}
        save_file({k: file.get_tensor(k) for k in file.keys()}, saved, metadata)
    with pytest.raises(CheckpointError, match="tiny.safetensors is damaged"):
        load(saved)


@pytest.mark.parametrize(
    "name, old, new",
    [
        ("config", '"skip": true', '"skip": false'),
        ("config", '"dropout": 0.0', '"dropout": 0.9'),
        ("schedule", "", "x"),
    ],
)
def test_a_changed_setting_is_damage(saved: Path, name: str, old: str, new: str):
    """It would load, and walk like nobody."""
    with safe_open(saved, "pt") as file:
        metadata = file.metadata()
        tensors = {k: file.get_tensor(k) for k in file.keys()}
    changed = metadata[name].replace(old, new) if old else metadata[name] + new
    assert changed != metadata[name]
    save_file(tensors, saved, metadata | {name: changed})
    with pytest.raises(CheckpointError, match="tiny.safetensors is damaged: its settings"):
        load(saved)


def test_a_schedule_out_of_range_or_of_another_length(saved: Path):
    rewrite(saved, lambda tensors: tensors["schedule.beta"].fill_(1.5))
    with pytest.raises(CheckpointError, match="every beta must lie between 0 and 1"):
        load(saved)
    save(tiny_walker(), saved)
    rewrite(
        saved,
        lambda tensors: tensors.update(
            {"schedule.beta": torch.full((9,), 0.4, dtype=torch.float64)}
        ),
    )
    with pytest.raises(CheckpointError, match="schedule.beta has the shape .9,.; it must be .6,."):
        load(saved)


NONSENSE = [
    '{"flow_steps": 3}',
    "{broken",
    '"a string"',
    '{"width": "wide"}',
    '{"heads": 0}',
    '{"target": "foo"}',
    '{"T_h": 1000000000}',
    '{"width": 1000000000000000000000000000000}',
    '{"hidden": 1000000}',
    None,
]


@pytest.mark.parametrize(
    ("setting", "refused"),
    [
        ({"turning": False}, ""),
        ({"turning": True}, r"settings .turning. of an earlier version: train it again, or load"),
        ({"wings": 2}, "settings .wings. of a later one: upgrade"),
        ({"wings": 2, "turning": False}, "settings .wings. of a later one: upgrade"),
    ],
)
def test_a_setting_of_another_version(saved: Path, setting: dict, refused: str):
    metadata = settings_of(saved)
    config = json.loads(metadata["config"]) | setting
    rewrite(saved, lambda tensors: None, metadata | {"config": json.dumps(config)})
    if refused:
        with pytest.raises(CheckpointError, match=refused):
            load(saved)
    else:
        assert load(saved).config.width == 16


@pytest.mark.parametrize("config", NONSENSE)
def test_a_configuration_that_makes_no_sense(saved: Path, config: str | None):
    metadata = {"format": checkpoints.WALKER.format, "schedule": "linear", "card": "{}"}
    rewrite(saved, lambda tensors: None, metadata | ({"config": config} if config else {}))
    with pytest.raises(CheckpointError, match="tiny.safetensors"):
        load(saved)


def test_a_larger_network_than_the_weights_is_not_built(saved: Path, monkeypatch):
    monkeypatch.setattr(checkpoints, "with_weights", lambda *_: pytest.fail("it was built"))
    metadata = settings_of(saved)
    config = json.loads(metadata["config"]) | {"width": 8192, "hidden": 9000}
    rewrite(saved, lambda tensors: None, metadata | {"config": json.dumps(config)})
    with pytest.raises(CheckpointError, match=r"disagree \(\S+ has the shape"):
        load(saved)


def test_a_network_that_computes_with_its_numbers_comes_back(saved: Path, monkeypatch):
    """Such a network cannot be outlined without its numbers."""
    made = []

    class Computing(MoDiff):
        def __init__(self, config):
            super().__init__(config)
            made.append(next(self.parameters()).sum().item())

    there = checkpoints.networks_of("walker")
    changed = there | {"MoDiff": replace(there["MoDiff"], model=Computing)}
    monkeypatch.setattr(checkpoints, "networks_of", lambda name: changed)
    assert load(saved).config.width == 16 and len(made) == 1


def test_a_network_of_a_later_version_is_refused_by_name(saved: Path):
    rewrite(saved, lambda tensors: None, settings_of(saved) | {"network": "BetterMoDiff"})
    with pytest.raises(CheckpointError, match="unknown network, BetterMoDiff; upgrade"):
        load(saved)


def test_a_whole_number_for_a_share_comes_back(tmp_path: Path):
    walker = tiny_walker()
    model = MoDiff(replace(walker.config, dropout=0))
    kept = save(replace(walker, model=model), tmp_path / "whole.safetensors")
    assert load(kept).config.dropout == 0
