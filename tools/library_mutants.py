"""Does `make quick` notice mistakes in the library? Forty of them, one at a time.

    python -m tools.library_mutants              each, with the test file of its own module
    python -m tools.library_mutants ddpm modiff  those of these modules
    python -m tools.library_mutants --all        each, with all tests of `make quick` (an hour)

A mutant is one small wrong change such as a person makes: a sign, an index one off, an axis, a root
left out, a mask turned round. The package is copied into a temporary folder and changed there. A
mutant is killed if a test fails; the changed package must still be importable. docs/CONTRIBUTING.md
says how many are killed, and `tests/tools/test_library_mutants.py` that each can be applied.
"""

import argparse
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from shutil import copytree

import hypothesis  # noqa: F401
import matplotlib.pyplot  # noqa: F401
import pytest
import scipy.stats  # noqa: F401
import torch  # noqa: F401  # imported once for all mutants, and nothing of this project

ROOT = Path(__file__).parent.parent
QUICK = ROOT / "tests" / "quick.txt"
COPIED = ("motiondiff_edu", "data_synth", "tests", "tools", "benchmarks")


@dataclass(frozen=True)
class Mutant:
    """`old`, which a file of the package has once, becomes `new`."""

    file: str
    old: str
    new: str
    tests: str = ""  # of its own module, if they are not `tests/<folder>/test_<name>.py`

    @property
    def test_file(self) -> str:
        path = Path(self.file)
        return self.tests or f"tests/{path.with_name(f'test_{path.name}').as_posix()}"

    def applied(self, text: str) -> str:
        """The text of the file with the mistake.  Raises ValueError unless `old` is there once."""
        if text.count(self.old) != 1:
            raise ValueError(f"{self.file} has {self.old!r} {text.count(self.old)} times, not once")
        return text.replace(self.old, self.new)


MUTANTS = (
    # schedules, noise, the two samplers
    Mutant("ddpm.py", "torch.cumprod(1 - beta, 0)", "1 - torch.cumsum(beta, 0)"),
    Mutant("ddpm.py", "* x0 + now.noise * noise", "* x0 + now.noise**2 * noise"),
    Mutant("ddpm.py", "(1 - beta) ** 0.5 * x_prev", "(1 - beta) * x_prev"),
    Mutant("ddpm.py", "schedule.beta[1:] * left[:-1]", "schedule.beta[1:] * left[1:]"),
    Mutant("ddpm.py", "to_x0 * x0 + to_x_s * x_s", "to_x0 * x0 - to_x_s * x_s"),
    Mutant("ddpm.py", "if s == 1:\n        return mean", "if s == 0:\n        return mean"),
    Mutant("ddpm.py", "* eps_hat) / now.alpha**0.5", "* eps_hat) / now.alpha"),
    Mutant("ddpm.py", "then.noise**2 - sigma**2", "then.noise**2"),
    Mutant("ddpm.py", "zip(visited, [*visited[1:], 0]", "zip(visited, [*visited[1:], 1]"),
    Mutant("ddpm.py", "return error.square().mean()", "return error.abs().mean()"),
    # what a network predicts
    Mutant("prediction.py", "(x_s - b * eps) / a", "(x_s - b * eps) * a"),
    Mutant("prediction.py", "return a * eps - b * x0", "return a * x0 - b * eps"),
    # MoDiff
    Mutant("modiff.py", "step_embedding(8 * torch.arange", "step_embedding(0 * torch.arange"),
    Mutant("modiff.py", " + self.time[self.config.T_h :]", ""),
    Mutant(
        "modiff.py", "out + self.skip[s][:, None, None] * x_s", "out + self.skip[s][:, None, None]"
    ),
    Mutant("modiff.py", "torch.randint(1, schedule.S + 1", "torch.randint(1, schedule.S"),
    Mutant("modiff.py", "past = dropout(past, s, generator)", "dropout(past, s, generator)"),
    # attention
    Mutant("cross_modal_attention.py", "math.sqrt(q.shape[-1])", "q.shape[-1]"),
    Mutant(
        "cross_modal_attention.py",
        "key_times[None, :] - query_times",
        "query_times - key_times[None, :] + 0 * query_times",
    ),
    Mutant("cross_modal_attention.py", "buckets //= 2", "buckets //= 1"),
    Mutant(
        "cross_modal_attention.py",
        "self.self_attention(normed, normed, bias)",
        "self.self_attention(normed, normed)",
    ),
    Mutant("cross_modal_attention.py", "a * sin + b * cos", "b * cos - a * sin"),
    # dropout of the past, rollout, reconstruction
    Mutant(
        "diffusion_dropout.py",
        "torch.rand(n, generator=generator) < rate",
        "torch.rand(n, generator=generator) > rate",
    ),
    Mutant(
        "diffusion_dropout.py",
        ".where(hit[:, None, None], past)",
        ".where(~hit[:, None, None], past)",
    ),
    Mutant("rollout.py", "rows[-1:] * T_p if hold", "rows[:1] * T_p if hold"),
    Mutant(
        "rollout.py", "window[:, :keep]], dim=1)[:, -T_h:]", "window[:, -keep:]], dim=1)[:, -T_h:]"
    ),
    Mutant(
        "rollout.py",
        "new = walker.pose_scaler.inverse(",
        "new = walker.pose_scaler.transform(",
        "tests/performers/test_walker.py",
    ),
    Mutant(
        "reconstruction.py",
        "back = -control[..., :-1, :].flip(-2)",
        "back = control[..., :-1, :].flip(-2)",
    ),
    Mutant("reconstruction.py", "torch.where(known, past, back)", "back"),
    # MoFusion
    Mutant(
        "mofusion.py",
        "scale, shift = self.step(step)[:, None].chunk(2, dim=-1)",
        "shift, scale = self.step(step)[:, None].chunk(2, dim=-1)",
    ),
    Mutant("mofusion.py", "return (out * levels[0].mask)[:, :T]", "return out[:, :T]"),
    Mutant("mofusion.py", "torch.where(allowed, 0.0, -1e4)", "torch.where(allowed, -1e4, 0.0)"),
    Mutant("kinematic_loss.py", "max(lengths.shape[1] - 1, 1)", "lengths.shape[1]"),
    Mutant(
        "kinematic_loss.py", "planted[:, 1:] & planted[:, :-1]", "planted[:, 1:] | planted[:, :-1]"
    ),
    Mutant("kinematic_loss.py", "(at(lambda_k, s, L_k) * L_k).mean()", "L_k.mean()"),
    Mutant(
        "inbetweening.py",
        "x = torch.where(known, q_sample(given, s, schedule, draw(x, generator)), x)",
        "x = torch.where(known, given, x)",
    ),
    Mutant("inbetweening.py", "    x = torch.where(known, given, x)\n", ""),
    # training, and the space around the networks
    Mutant("training.py", "state.model.train()  # at each step", "# at each step"),
    Mutant(
        "motion/root_frame.py", "forward_left(heading + step[:, 2] / 2)", "forward_left(heading)"
    ),
    Mutant(
        "motion/augment.py",
        "control[:-1] = -clip.control[:-1][::-1]",
        "control[:-1] = clip.control[:-1][::-1]",
    ),
)


def folder_copied(target: Path) -> None:
    """The checkout under `target`; each file is a link, and only the folders are new."""
    for path in ROOT.iterdir():
        if path.name in COPIED:
            copytree(path, target / path.name, copy_function=os.symlink)
        elif path.name not in (".git", "build"):
            (target / path.name).symlink_to(path)


def failed(copy: Path, tests: list[str]) -> bool:
    """Whether a test fails in the copy.  Raises RuntimeError if pytest cannot run them.

    A child of this process runs them: it has torch already, which takes longer than most tests.
    """
    with tempfile.TemporaryFile("w+") as said:
        child = os.fork()
        if not child:
            for stream in (1, 2):
                os.dup2(said.fileno(), stream)
            os.chdir(copy)
            os.environ["PYTHONPATH"] = str(copy)
            sys.path.insert(0, str(copy))
            sys.dont_write_bytecode = True
            os._exit(pytest.main(["-q", "-x", "-p", "no:cacheprovider", *tests]))
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if code not in (0, 1):  # 1: a test failed
            said.seek(0)
            raise RuntimeError(f"pytest could not run {tests} ({code}):\n{said.read()}")
    return code == 1


def killed(mutant: Mutant, copy: Path, tests: list[str]) -> bool:
    """Whether a test fails with the mutant, which is put into the copy and taken out again."""
    original = ROOT / "motiondiff_edu" / mutant.file
    changed = copy / "motiondiff_edu" / mutant.file
    changed.unlink()
    changed.write_text(mutant.applied(original.read_text(encoding="utf-8")), encoding="utf-8")
    try:
        return failed(copy, tests)
    finally:
        changed.unlink()
        changed.symlink_to(original)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tools.library_mutants", description=__doc__)
    parser.add_argument("modules", nargs="*", help="such as ddpm or motion/augment; default: all")
    parser.add_argument("--all", action="store_true", help="all tests of `make quick` for each")
    chosen = parser.parse_args()
    quick = QUICK.read_text(encoding="utf-8").split()
    names = [f"{name}.py" for name in chosen.modules]
    mutants = [one for one in MUTANTS if not names or one.file in names]
    needed = {one: quick if chosen.all else [one.test_file] for one in mutants}
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        folder_copied(Path(folder))
        if failed(Path(folder), sorted({test for tests in needed.values() for test in tests})):
            raise SystemExit("a test fails without any mutant: mend that first")
        for one in mutants:
            dead = killed(one, Path(folder), needed[one])
            count += dead
            said = "killed  " if dead else "SURVIVES"
            print(f"{said} {one.file}: {one.old.strip()!r} -> {one.new.strip()!r}", flush=True)
    print(f"{count} of {len(mutants)} killed")


if __name__ == "__main__":
    main()
