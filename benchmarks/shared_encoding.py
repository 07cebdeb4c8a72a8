"""A training step of the walker in which two noises share one encoding of their window.

It is compared with a step on twice as many windows that have one noise each: the loss has as many
terms in both. One thread; loss and gradients, without the optimizer.
Run: python benchmarks/shared_encoding.py [--repeats 15] [--out
benchmarks/results/shared_encoding.json]
"""

import argparse
from collections.abc import Callable
from dataclasses import replace

import torch
from records import record, show, write_records
from timing import in_turn

from data_synth.walking import dataset
from motiondiff_edu.motion.clip import Clip
from motiondiff_edu.recipes.walker import WALKER_TRUNK, WalkerRecipe, prepared

COMMAND = "python -m benchmarks encoding"


def step(recipe: WalkerRecipe, clips: list[Clip]) -> Callable[[], None]:
    """A function that computes the recipe's loss on a new batch, and its gradients."""
    begun = prepared(recipe, clips)
    generator = torch.Generator().manual_seed(0)

    def run() -> None:
        begun.model.zero_grad(set_to_none=True)
        begun.loss_fn(begun.model, generator).backward()

    return run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--out", default="benchmarks/results/shared_encoding.json")
    args = parser.parse_args()
    torch.set_num_threads(1)
    shared = WALKER_TRUNK
    apart = replace(shared, noises=1, batch=shared.noises * shared.batch)
    clips = dataset(8, 10.0, seed=0)
    runs = {"shared": step(shared, clips), "apart": step(apart, clips)}
    times = in_turn(runs, args.repeats, warmup=2)
    records = [
        record(f"bench.shared_encoding_ms.{name}", values, unit="ms", command=COMMAND)
        for name, values in times.items()
    ]
    over = times["shared"] / times["apart"]
    records.append(record("bench.shared_encoding_over_apart", over, unit="ratio", command=COMMAND))
    show(records)
    write_records(args.out, records)


if __name__ == "__main__":
    main()
