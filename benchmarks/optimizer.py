"""Adam beside Muon for the same CPU-seconds: the small MoDiff, the same data and loss, the loss on unseen windows.

One thread; the loss is the recipe's own, on windows of unseen clips, of the averaged weights.
Run: python -m benchmarks optimizer [--seconds 120] [--out benchmarks/results/optimizer.json]
"""

import argparse

import numpy as np
import torch
from records import record, show, write_records

from data_synth.walking import dataset
from motiondiff_edu.ddpm import linear_schedule
from motiondiff_edu.motion.augment import augment
from motiondiff_edu.pretrained.budget import train_for
from motiondiff_edu.windows import Windows, window_loss

COMMAND = "python -m benchmarks optimizer"
LOSS = {"batch": 32, "noises": 2, "jitter": 0.3, "metres": 2.0, "near": 1.0}
LR = {"adam": 1e-3, "muon": 3e-3}  # each the better of 1e-3 and 3e-3


def unseen_losses(walker, clips: list, batches: int = 40) -> np.ndarray:
    """The loss on `batches` batches of unseen windows, the same for every walker."""
    windows = Windows.of(clips, scalers=(walker.pose_scaler, walker.control_scaler))
    loss_fn, generator = (
        window_loss(windows, linear_schedule(walker.config.S), **LOSS),
        torch.Generator().manual_seed(7),
    )
    with torch.no_grad():
        return np.array([loss_fn(walker.model, generator).item() for _ in range(batches)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--clips", type=int, default=300)
    parser.add_argument("--out", default="benchmarks/results/optimizer.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    known, unknown = augment(dataset(args.clips, 20.0, seed=1)), dataset(40, 12.0, seed=910_000)
    losses, records = {}, []
    for name, lr in LR.items():
        walker, steps = train_for(args.seconds, known, lr=lr, optimizer=name, **LOSS)
        losses[name] = unseen_losses(walker, unknown)
        records.append(record(f"bench.optimizer_{name}_loss", losses[name], unit="loss", command=COMMAND))
        print(f"{name}: {steps} steps", flush=True)
    records.append(
        record("bench.optimizer_adam_loss_over_muon", losses["adam"] / losses["muon"], unit="ratio", command=COMMAND)
    )
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
