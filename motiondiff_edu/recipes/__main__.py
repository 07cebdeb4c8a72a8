"""`python -m motiondiff_edu.recipes [NAME ...]`: train the shipped performers.

All that are shipped, the judges of words included (hours), or those named.
"""

import argparse
import sys
from pathlib import Path

import torch

from ..conditions import clip as clips
from ..pretrained.checkpoints import AnyPerformer, load, save
from ..pretrained.judges import save_judge
from .dancer import DANCE_RECIPES, SHIPPED_DANCERS, train_dancer
from .ear import TrainedEar, ear_within
from .inbetweener import INBETWEENER, train_inbetweener
from .judges import JUDGES, train_judge
from .mover import MOVER, MOVER_RECIPES, train_mover
from .recordings import RecordingsError, recording_files
from .walker import RECIPES, SHIPPED, clips_of, train

ALL = RECIPES | DANCE_RECIPES | {INBETWEENER.name: INBETWEENER} | MOVER_RECIPES | JUDGES
EVERY = [
    recipe.name for recipe in (*SHIPPED, *SHIPPED_DANCERS, INBETWEENER, MOVER, *JUDGES.values())
]


def main() -> None:
    """Run `python -m motiondiff_edu.recipes [NAME ...]`."""
    parser, chosen = arguments()
    torch.set_num_threads(chosen.threads)
    given = {"device": chosen.device, "data": chosen.data, "clip": chosen.clip}
    ear = None
    if chosen.ear:
        try:
            ear = ear_within(load(chosen.ear))
        except ValueError as error:
            parser.exit(1, f"--ear {chosen.ear}: {error}\n")
    chosen.runs.mkdir(parents=True, exist_ok=True)
    for name in chosen.names or buildable(EVERY):
        file = f"{name}-own.safetensors" if chosen.data else f"{name}.safetensors"
        try:
            made = build(name, chosen.runs / file, chosen.out / file, ear=ear, **given)
        except (clips.ClipError, clips.NoTransformers, ValueError) as error:
            parser.exit(1, f"{name}: {error}\n")
        print("wrote", made)


def arguments() -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """What was asked for on the command line, checked before anything is trained."""
    parser = argparse.ArgumentParser(prog="python -m motiondiff_edu.recipes", description=__doc__)
    parser.add_argument(
        "names", nargs="*", help=f"which of {', '.join(ALL)}; none: all that are shipped"
    )
    parser.add_argument(
        "--runs",
        type=Path,
        default=Path("build/runs"),
        help="where runs are saved and resumed from (default: build/runs)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("trained"),
        help="the folder for the weights (default: trained, in the current folder); a file of the "
        "same name is replaced",
    )
    parser.add_argument(
        "--clip",
        metavar="FOLDER",
        help="where the CLIP of mover-clip is (default: where transformers keeps its downloads)",
    )
    parser.add_argument(
        "--ear",
        metavar="DANCER",
        help="a dancer, by name or file, whose ear the dancers take over (default: an ear is "
        "trained first, which takes longer than a dancer)",
    )
    parser.add_argument(
        "--data",
        type=Path,
        metavar="FOLDER",
        help="train a walker on the motions in this folder (BVH, npz, ...), not on synthetic ones; "
        "its run and its weights are named NAME-own",
    )
    parser.add_argument(
        "--device", help="cpu or cuda (default: a GPU, if there is one that torch can use)"
    )
    parser.add_argument("--threads", type=int, default=torch.get_num_threads())
    chosen = parser.parse_args()
    unknown = set(chosen.names) - set(ALL)
    if unknown:
        parser.error(
            f"no recipe is called {', '.join(sorted(unknown))}; there are: {', '.join(ALL)}"
        )
    not_walkers = [name for name in chosen.names or ["all"] if name not in RECIPES]
    if chosen.data and not_walkers:
        parser.error(f"--data is for walkers ({', '.join(RECIPES)}), not {not_walkers[0]}")
    if chosen.device:
        try:
            torch.empty(0, device=chosen.device)
        except (RuntimeError, AssertionError) as error:
            words = str(error).splitlines()[0]
            parser.error(f"--device {chosen.device} cannot be used here: {words}")
    return parser, chosen


def buildable(names: list[str]) -> list[str]:
    """The recipes that can be trained here; says which ones need recordings that are not there."""
    missing = ""
    try:
        recording_files()
    except RecordingsError as error:
        missing = str(error)
    need = [name for name in names if getattr(ALL[name], "recordings", 0)] if missing else []
    for name in need:
        say(f"{name} is left out, since it is trained on recordings as well: {missing}")
    return [name for name in names if name not in need]


def build(
    name: str,
    run: Path,
    out: Path,
    *,
    device: str | None = None,
    data: Path | None = None,
    clip: str | None = None,
    ear: TrainedEar | None = None,
) -> Path:
    """Train a recipe by its name, continuing `run` where there is one, and save it as `out`.

    The rest is as in `trained`. A judge is saved in a folder of its own beside `out`.
    """
    if name in JUDGES:
        judge = train_judge(JUDGES[name], run, say, device)
        return save_judge(judge, out.parent / "judges" / out.name)
    made = trained(name, run, device=device, data=data, clip=clip, ear=ear)
    return save(made, out, bits=8)


def trained(
    name: str,
    run: Path,
    *,
    device: str | None = None,
    data: Path | None = None,
    clip: str | None = None,
    ear: TrainedEar | None = None,
) -> AnyPerformer:
    """The performer of a recipe, trained, or continued from `run`.

    `data` is a folder with motions for a walker, `clip` the folder of a CLIP, and `ear` a trained
    ear; recipes that need none leave them. If the recipe continues another one, that is trained
    first; its run file lies beside `run`.
    """
    if name in DANCE_RECIPES:
        recipe = DANCE_RECIPES[name]
        own = ear if recipe.ear else None
        return train_dancer(recipe, run, log=say, ear=own, device=device)
    if name == INBETWEENER.name:
        return train_inbetweener(INBETWEENER, run, log=say, device=device)
    if name in MOVER_RECIPES:
        recipe = MOVER_RECIPES[name]
        reader = clips.load(clip) if clip and recipe.config.clip else None
        return train_mover(recipe, run, log=say, clip=reader, device=device)
    recipe, first = RECIPES[name], None
    if recipe.begins_with:
        before = run.with_name(f"{recipe.begins_with}.safetensors")
        first = trained(recipe.begins_with, before, data=data, device=device).model
    own = clips_of(data) if data else None
    return train(recipe, run, own, log=say, first=first, device=device)


def say(line: str) -> None:
    """Print a line of a training's log."""
    print(line, flush=True)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        print("\nstopped; the same command continues from the last save", file=sys.stderr)
        sys.exit(130)
