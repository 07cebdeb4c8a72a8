"""The training loop.

It learns, averages, clips, saves no code, survives a kill, stops at a non-finite loss.
"""

import math
import os
import pickletools
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import torch
from safetensors.torch import load_file, save_file
from torch import nn

from motiondiff_edu.modiff import MoDiff, MoDiffConfig
from motiondiff_edu.recipes.muon import MuonAndAdam
from motiondiff_edu.recipes.training import notes_of, resume_run, save_run, saver
from motiondiff_edu.training import NonFiniteLoss, Saving, TrainState, cosine_lr, train_steps


def network():
    """Dropout draws from torch's own generator, the batches from the run's.

    Both must be resumed.
    """
    torch.manual_seed(3)
    return nn.Sequential(nn.Linear(5, 7), nn.Tanh(), nn.Dropout(0.2), nn.Linear(7, 2))


def toy_loss(model, generator):
    x = torch.randn(11, 5, generator=generator)
    return (model(x) - x[:, :2] * x[:, 3:]).square().mean()


def every_eighth(path) -> Saving:
    """It is asked after each step, and writes every eighth and the 40th."""
    write = saver(path).write
    return Saving(lambda state: state.step % 8 or write(state), every=0.0)


def run(path, steps, resume=False, pause=0):
    torch.set_num_threads(1)
    state = TrainState.start(network(), seed=4)
    torch.manual_seed(5)
    if resume:
        resume_run(state, path)
    lr = cosine_lr(1e-2, 40, warmup=6)
    for report in train_steps(
        state, toy_loss, steps, lr=lr, save=every_eighth(path), progress=False
    ):
        if report.step == pause:
            print("paused", flush=True)
            sys.stdin.read()  # until killed
    return state


def test_loss_falls_on_a_toy():
    state = TrainState.start(nn.Linear(3, 2), seed=0)
    rule = torch.tensor([[1.0, -2.0, 0.5], [0.0, 3.0, 1.0]])

    def loss_fn(model, generator):
        x = torch.randn(17, 3, generator=generator)
        return (model(x) - x @ rule.T).square().mean()

    losses = [report.loss for report in train_steps(state, loss_fn, 400, lr=3e-2, progress=False)]
    assert losses[-1] < 1e-3 * losses[0]
    assert torch.allclose(state.model.weight, rule, atol=0.02)
    assert state.step == 400 and not state.model.training


def environment() -> dict:
    """This process' environment, with the checkout on the path."""
    return os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}


def test_a_killed_run_resumes_bit_for_bit(tmp_path: Path):
    whole = tmp_path / "whole.safetensors"
    killed = tmp_path / "killed.safetensors"
    expected = run(whole, 40)
    command = [
        sys.executable,
        __file__,
        str(killed),
    ]  # this file, run as a script: see its last lines
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, stdout=pipe, stdin=pipe, text=True, env=environment()
    ) as process:
        assert process.stdout.readline() == "paused\n"
        process.send_signal(signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    state = run(killed, 0, resume=True)
    assert state.step == 16  # the run was saved there; steps 17 to 21 are lost
    again = run(killed, 40, resume=True)
    assert again.step == expected.step == 40
    first, second = load_file(whole), load_file(killed)
    assert first.keys() == second.keys()
    different = [name for name in first if not torch.equal(first[name], second[name])]
    assert different == []


def test_before_each_step_is_told_how_many_are_done():
    """The first is told 0, and a training that goes on continues the count."""
    state = TrainState.start(network(), seed=4)
    told, at_loss = [], []

    def loss_fn(model, generator):
        at_loss.append(told[-1])
        return toy_loss(model, generator)

    for _ in train_steps(state, loss_fn, 3, before=told.append, progress=False):
        pass
    assert told == at_loss == [0, 1, 2]
    for _ in train_steps(state, loss_fn, 5, before=told.append, progress=False):
        pass
    assert told == at_loss == [0, 1, 2, 3, 4]


def test_a_look_at_the_model_between_steps_changes_nothing():
    """Who samples on the way switches dropout off; the next step has it again."""
    plain, looked_at = TrainState.start(network(), seed=4), TrainState.start(network(), seed=4)
    modes = []

    def loss_fn(model, generator):
        modes.append(model.training)
        return toy_loss(model, generator)

    for _ in train_steps(looked_at, loss_fn, 5, progress=False):
        looked_at.model.eval()
    assert modes == [True] * 5
    for _ in train_steps(plain, toy_loss, 5, progress=False):
        break
    assert not plain.model.training  # it was stopped half-way, and can be used
    assert not any(part.training for part in plain.average.modules())  # no dropout in what is used


def test_another_seed_gives_another_run(tmp_path: Path):
    """So that the test above could fail."""
    one = run(tmp_path / "a", 8)
    other = TrainState.start(network(), seed=9)
    torch.manual_seed(5)
    for _ in train_steps(other, toy_loss, 8, lr=cosine_lr(1e-2, 40, warmup=6), progress=False):
        pass
    assert not torch.equal(one.model[0].weight, other.model[0].weight)


def test_what_is_saved_is_safetensors_and_no_pickle(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = run(path, 8)
    tensors = load_file(path)
    assert torch.equal(tensors["model.0.weight"], state.model[0].weight)
    assert torch.equal(tensors["random.generator"], state.generator.get_state())
    with pytest.raises(Exception):  # noqa: B017  (pickletools has no error class of its own)
        pickletools.dis(path.read_bytes())
    assert [p.name for p in tmp_path.iterdir()] == ["run.safetensors"]  # the temporary name is gone


def test_a_run_of_another_network_is_refused(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    run(path, 8)
    with pytest.raises(RuntimeError, match="size mismatch|Missing key"):
        resume_run(TrainState.start(nn.Linear(5, 2)), path)


def test_a_file_that_is_no_run_is_refused_with_what_to_do(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(network())
    path.write_bytes(b"not a run at all")
    with pytest.raises(ValueError, match=r"run\.safetensors cannot be resumed: damaged.*delete it"):
        resume_run(state, path)
    save_file({"model.0.weight": torch.zeros(7, 5)}, path)
    with pytest.raises(ValueError, match=r"run\.safetensors is not a saved run: it has no average"):
        resume_run(state, path)


def test_a_run_begun_with_other_settings_is_refused(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(network())
    save_run(state, path, {"jitter": 0.3, "styles": ("old", "tired")})
    assert resume_run(state, path, {"jitter": 0.3, "styles": ("old", "tired")}) is state
    with pytest.raises(ValueError, match=r"begun with jitter = 0\.3, not 0\.1: delete the file"):
        resume_run(state, path, {"jitter": 0.1, "styles": ("old", "tired")})
    save_run(state, path)
    with pytest.raises(ValueError, match="begun with jitter = None"):
        resume_run(state, path, {"jitter": 0.1})
    with pytest.raises(ValueError, match="begun with note = None"):  # it did not know of notes
        resume_run(state, path, {"note": None})


def test_the_moments_of_one_optimizer_are_not_given_to_another(tmp_path: Path):
    model = MoDiff(MoDiffConfig(T_h=4, T_p=3, S=6, width=16, heads=2, hidden=24))
    path = tmp_path / "run.safetensors"
    save_run(TrainState.start(model, optimizer=MuonAndAdam(model)), path)
    with pytest.raises(ValueError, match="trained by MuonAndAdam, not by Adam"):
        resume_run(TrainState.start(model), path)


def test_notes_are_kept_and_do_not_hinder(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(network())
    assert notes_of(path) == []
    save_run(state, path, notes=[{"from_step": 0}])
    assert notes_of(path) == [{"from_step": 0}] and resume_run(state, path) is state


def test_the_seconds_of_a_run_go_on_counting(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    before = run(path, 8).seconds
    state = resume_run(TrainState.start(network()), path)
    assert state.seconds == before > 0
    assert run(path, 16, resume=True).seconds > before


def bad_at(step: int, value: float):
    """A loss that is fine until `step`, and `value` from then on."""
    calls = []

    def loss_fn(model, generator):
        calls.append(1)
        loss = (model(torch.randn(4, 3, generator=generator)) - 1).square().mean()
        return loss * value if len(calls) == step + 1 else loss

    return loss_fn


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_non_finite_loss_stops_and_keeps_the_last_good_weights(tmp_path: Path, value: float):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(nn.Linear(3, 2), seed=1)
    good = []
    with pytest.raises(
        NonFiniteLoss, match=r"^step 6: the loss is (nan|inf).*learning rate.*run\.safetensors"
    ):
        for _ in train_steps(
            state, bad_at(6, value), 20, save=saver(path, every=1e9), progress=False
        ):
            good.append(state.model.weight.detach().clone())
    assert len(good) == state.step == 6
    assert torch.equal(state.model.weight, good[-1])
    assert torch.isfinite(state.average.weight).all()
    assert torch.equal(load_file(path)["model.weight"], good[-1])


def test_broken_weights_are_not_saved_over_good_ones(tmp_path: Path):
    class Breaks(torch.optim.SGD):
        def step(self):
            for weight in (p for group in self.param_groups for p in group["params"]):
                weight.data.fill_(math.nan)

    path, model = tmp_path / "run.safetensors", nn.Linear(3, 2)
    state, bad = TrainState.start(model, seed=1), bad_at(99, math.nan)
    list(train_steps(state, bad, 5, save=saver(path, every=1e9), progress=False))
    before = path.read_bytes()
    state.optimizer = Breaks(model.parameters(), lr=0.1)
    with pytest.raises(
        NonFiniteLoss, match="step 6: .* had broken the weights already; they are not saved"
    ):
        list(train_steps(state, bad, 20, save=saver(path, every=1e9), progress=False))
    assert path.read_bytes() == before


def test_a_run_is_saved_by_the_seconds_of_its_training(monkeypatch):
    """By a clock on which each step takes a second."""
    ticks = iter(range(10**6))
    monkeypatch.setattr("motiondiff_edu.training.time.perf_counter", lambda: next(ticks))
    saved = []
    state = TrainState.start(nn.Linear(3, 2), seed=1)
    state.seconds = 100.0  # of sittings before
    save = Saving(lambda state: saved.append(state.step), every=3.0)
    list(train_steps(state, bad_at(99, math.nan), 8, save=save, progress=False))
    assert saved == [3, 6, 8]


def test_the_last_step_is_saved_whatever_its_number(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(nn.Linear(3, 2), seed=1)
    list(train_steps(state, bad_at(99, math.nan), 7, save=saver(path, every=1e9), progress=False))
    assert resume_run(TrainState.start(nn.Linear(3, 2), seed=1), path).step == 7


def test_a_flipped_bit_in_a_saved_run_is_found(tmp_path: Path):
    path = tmp_path / "run.safetensors"
    state = TrainState.start(nn.Linear(3, 2), seed=1)
    list(train_steps(state, bad_at(99, math.nan), 3, save=saver(path), progress=False))
    raw = bytearray(path.read_bytes())
    raw[-1] ^= 0x40
    path.write_bytes(raw)
    with pytest.raises(ValueError, match="run.safetensors cannot be resumed: damaged"):
        resume_run(TrainState.start(nn.Linear(3, 2), seed=1), path)


def test_a_non_finite_gradient_stops_too():
    def loss_fn(model, generator):  # sqrt(0) is 0, its slope is not finite
        return (model(torch.zeros(2, 3)) * 0).square().sum().sqrt()

    state = TrainState.start(nn.Linear(3, 2), seed=1)
    before = state.model.weight.detach().clone()
    with pytest.raises(NonFiniteLoss, match="step 0: the loss is 0.0, the gradient's norm nan"):
        next(train_steps(state, loss_fn, 5, progress=False))
    assert torch.equal(state.model.weight, before)


def test_the_average_is_exponential_with_a_shorter_memory_at_the_start():
    state, decay = TrainState.start(nn.Linear(3, 2), seed=2, decay=0.7), 0.7
    mean = state.model.weight.detach().clone()

    def loss_fn(model, generator):
        return (model(torch.randn(4, 3, generator=generator)) - 1).square().mean()

    for i, _ in enumerate(train_steps(state, loss_fn, 60, lr=0.1, progress=False)):
        share = min(decay, (1 + i) / (10 + i))
        mean = share * mean + (1 - share) * state.model.weight.detach()
    assert share == decay  # the start is over: both branches were seen
    assert torch.allclose(state.average.weight, mean, atol=1e-6)
    assert not torch.allclose(state.average.weight, state.model.weight, atol=1e-4)
    assert not state.average.weight.requires_grad


def test_the_average_s_memory_of_the_first_steps_by_hand():
    """One weight that every step lowers by 1: 0, -1, -2, -3. The memory is 1/10, 2/11, 3/12 long,
    so the start is soon forgotten."""

    class Falls(nn.Module):
        def __init__(self):
            super().__init__()
            self.weight = nn.Parameter(torch.zeros(()))

    state = TrainState.start(Falls())
    state.optimizer = torch.optim.SGD(state.model.parameters())
    loop = train_steps(state, lambda model, generator: model.weight, 3, lr=1.0, progress=False)
    found = [state.average.weight.item() for _ in loop]
    first = -1 * 9 / 10
    second = first * 2 / 11 - 2 * 9 / 11
    third = second * 3 / 12 - 3 * 9 / 12
    assert found == pytest.approx([first, second, third])


def test_gradients_are_clipped_and_the_norm_is_reported():
    seen = []

    class Spy(torch.optim.SGD):
        def step(self, closure=None):
            seen.append(
                torch.cat([p.grad.flatten() for g in self.param_groups for p in g["params"]])
                .norm()
                .item()
            )
            super().step(closure)

    state = TrainState.start(nn.Linear(3, 2), seed=2)
    state.optimizer = Spy(state.model.parameters(), lr=1e-3)

    def loss_fn(model, generator):
        return 1000 * model(torch.ones(4, 3)).sum()

    reports = list(train_steps(state, loss_fn, 3, clip=0.25, progress=False))
    assert seen == pytest.approx([0.25] * 3, rel=1e-4)
    # d/dw = 4000 for each of 6 weights, d/db = 4000 for each of 2 biases
    assert reports[0].grad_norm == pytest.approx(4000 * math.sqrt(8), rel=1e-5)


def test_learning_rate_rises_then_falls_and_is_used():
    lr = cosine_lr(0.4, 110, warmup=10)
    assert [lr(0), lr(4), lr(9)] == pytest.approx([0.04, 0.2, 0.4])
    assert lr(10) == pytest.approx(0.4)
    assert lr(60) == pytest.approx(0.2)
    assert lr(110) == pytest.approx(0) and lr(500) == pytest.approx(0)
    state = TrainState.start(nn.Linear(3, 2))
    loss = lambda model, generator: model(torch.ones(1, 3)).square().mean()  # noqa: E731
    reports = list(train_steps(state, loss, 12, lr=lr, progress=False))
    assert [r.lr for r in reports] == pytest.approx([lr(i) for i in range(12)])
    assert state.optimizer.param_groups[0]["lr"] == pytest.approx(lr(11))


if __name__ == "__main__":  # the run that test_a_killed_run_resumes_bit_for_bit kills
    run(sys.argv[1], 40, pause=21)
