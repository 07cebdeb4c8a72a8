"""A network of one's own: registered, it is built, walked with, saved and loaded like ours."""

from dataclasses import dataclass
from pathlib import Path

import pytest
import torch
from torch import nn

from motiondiff_edu.baselines.transformer import DanceTransformer, TransformerConfig
from motiondiff_edu.ddpm import cosine_schedule, linear_schedule
from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.mofusion import MoFusion, MoFusionConfig
from motiondiff_edu.motion.scaler import Scaler
from motiondiff_edu.performers import networks
from motiondiff_edu.performers.dancer import Dancer
from motiondiff_edu.performers.networks import kind_of, network, networks_of, register
from motiondiff_edu.performers.walker import Walker
from motiondiff_edu.pretrained.checkpoints import CheckpointError, load, save
from motiondiff_edu.rollout import generate

T_H, T_P = 4, 3
S = 6
POSE = Scaler(torch.linspace(-2, 3, 63), torch.linspace(0.1, 0.6, 63))
CONTROL = Scaler(torch.tensor([1.0, 0.1, -0.2]), torch.tensor([0.5, 0.2, 0.8]))


@dataclass(frozen=True)
class LinearConfig:
    D: int = 63
    C: int = 3
    S: int = S
    T_h: int = T_H
    T_p: int = T_P
    target: str = "x0"


class LinearWalker(nn.Module):
    """Whatever the noise: the future is linear in the past."""

    def __init__(self, config: LinearConfig):
        super().__init__()
        self.config = config
        self.ahead = nn.Linear(config.T_h, config.T_p)

    def listen(self, *music):
        """So that it can be registered for a dancer, too."""

    def encode(self, past, control):
        return self.ahead(past.mT).mT

    def decode(self, x_s, s, memory):
        return memory

    def forward(self, x_s, s, past, control):
        return self.decode(x_s, s, self.encode(past, control))


@pytest.fixture()
def registry(monkeypatch):
    monkeypatch.setattr(networks, "_NETWORKS", dict(networks._NETWORKS))


def linear_walker() -> Walker:
    torch.manual_seed(0)
    schedule = linear_schedule(S, 0.2, 0.95)
    return Walker(LinearWalker(LinearConfig()).eval(), schedule, POSE, CONTROL, {"name": "mine"})


def walked(walker: Walker) -> torch.Tensor:
    past = torch.randn(2, T_H, 63, generator=torch.Generator().manual_seed(1))
    return generate(walker, past, torch.zeros(2, T_H + 5, 3), seed=3)


def test_a_network_of_ones_own_walks_is_saved_and_loaded(registry, tmp_path: Path):
    register("walker", LinearWalker, LinearConfig)
    mine = linear_walker()
    assert walked(mine).shape == (2, 5, 63)
    back = load(save(mine, tmp_path / "mine.safetensors", bits=32))
    assert type(back.model) is LinearWalker and back.config == LinearConfig()
    assert torch.equal(walked(back), walked(mine))
    assert type(network(LinearConfig())) is LinearWalker


def test_without_registering_it_is_neither_saved_nor_loaded(registry, tmp_path: Path):
    path = tmp_path / "mine.safetensors"
    with pytest.raises(ValueError, match='not registered.*register."walker", LinearWalker, Linear'):
        save(linear_walker(), path)
    assert not path.exists()
    register("walker", LinearWalker, LinearConfig)
    save(linear_walker(), path)
    del networks._NETWORKS["LinearWalker"]
    with pytest.raises(CheckpointError, match="unknown network, LinearWalker.*register it first"):
        load(path)
    with pytest.raises(ValueError, match="no network is registered for LinearConfig"):
        network(LinearConfig())


def test_a_dancers_network_is_no_walkers(registry, tmp_path: Path):
    register("dancer", LinearWalker, LinearConfig)
    with pytest.raises(ValueError, match="not registered"):
        save(linear_walker(), tmp_path / "mine.safetensors")


def test_ours_are_registered():
    assert list(networks_of("walker")) == ["MoDiff"]
    dancers = {"MoFusion", "DanceTransformer"}
    assert set(networks_of("dancer")) == dancers | {"HearingMoFusion", "HearingTransformer"}
    assert list(networks_of("inbetweener")) == ["KeyframeMoFusion"]
    sizes = {"T_h": T_H, "T_p": T_P, "S": S, "width": 16, "heads": 2, "hidden": 24}
    built = {
        MoDiff: network(MoDiffConfig(**sizes)),
        MoFusion: network(MoFusionConfig(C=5, widths=(16, 24), heads=2, music_layers=1)),
        DanceTransformer: network(TransformerConfig(C=5, width=16, heads=2, layers=1)),
    }
    for kind, one in built.items():
        assert type(one) is kind and kind_of(one).model is kind


@dataclass(frozen=True)
class WithoutTarget:
    D: int = 63
    C: int = 3
    S: int = 6
    T_h: int = 4
    T_p: int = 3


@dataclass(frozen=True)
class Bare:
    D: int
    C: int = 3
    S: int = 6
    T_h: int = 4
    T_p: int = 3
    target: str = "x0"


class Unable(nn.Module):
    def encode(self, past, control):
        return past, control


@pytest.mark.parametrize(
    "arguments, words",
    [
        (("singer", LinearWalker, LinearConfig), "not 'singer'"),
        (("walker", LinearWalker, WithoutTarget), "WithoutTarget lacks target"),
        (("walker", LinearWalker, Bare), "Bare has no default for D"),
        (("walker", Unable, LinearConfig), "Unable has no method decode: a walker calls encode, d"),
    ],
)
def test_what_cannot_be_registered(registry, arguments, words):
    with pytest.raises(ValueError, match=words):
        register(*arguments)


def test_a_network_belongs_to_one_performer(registry):
    register("walker", LinearWalker, LinearConfig)
    with pytest.raises(ValueError, match="LinearWalker is a walker's network already"):
        register("dancer", LinearWalker, LinearConfig)


def test_a_name_belongs_to_one_class_which_may_be_defined_again(registry):
    other = type("MoDiff", (LinearWalker,), {})
    with pytest.raises(ValueError, match="MoDiff is the name of motiondiff_edu.modiff.MoDiff"):
        register("walker", other, MoDiffConfig)
    again = type("LinearWalker", (LinearWalker,), {"__module__": __name__})
    register("walker", LinearWalker, LinearConfig)
    register("walker", again, LinearConfig)  # as a notebook's cell that is run twice
    assert networks_of("walker")["LinearWalker"].model is again
    assert kind_of(linear_walker().model).model is again


def test_a_configuration_names_one_network(registry):
    with pytest.raises(ValueError, match="MoDiffConfig belongs to motiondiff_edu.modiff.MoDiff"):
        register("walker", LinearWalker, MoDiffConfig)
    assert type(network(MoDiffConfig(width=16, heads=2))) is MoDiff


class Forgetful(LinearWalker):
    """It forgets half of its past, in training."""

    def forward(self, x_s, s, past, control):
        return self.ahead(nn.functional.dropout(past, 0.5, self.training).mT).mT


def test_a_network_left_in_training_is_used_without_dropout(registry):
    torch.manual_seed(0)
    model = Forgetful(LinearConfig())
    one = Walker(model.train(), linear_schedule(S, 0.2, 0.95), POSE, CONTROL)
    assert torch.equal(walked(one), walked(one)) and model.training
    assert torch.equal(walked(one), walked(linear_walker()))


def test_a_dancer_with_a_transformer_dances(tmp_path: Path):
    torch.manual_seed(0)
    config = TransformerConfig(C=5, S=12, width=16, heads=2, layers=1, music_layers=1)
    scalers = Scaler(torch.zeros(63), torch.ones(63)), Scaler(torch.zeros(5), torch.ones(5))
    one = Dancer(DanceTransformer(config).eval(), cosine_schedule(12), *scalers)
    assert one.dance_mel(torch.randn(1, 40, 5), 20, steps=2).shape == (1, 20, 21, 3)
