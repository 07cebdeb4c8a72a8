"""Train a recipe of a dancer from songs and dances that all cores have made before.

    python kept/songs.py; python kept/train.py data; python kept/train.py dancer

The same data as `python -m motiondiff_edu.recipes dancer` makes on one core. The ear is that of
kept/ear.safetensors. MADE names the folder of all files.
"""

import json
import os
import pickle
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import torch
from safetensors import safe_open

torch.set_num_threads(int(os.environ.get("OMP_NUM_THREADS", "1")))
from data_synth.dancing.performance import DANCES_A_SEED, dance
from motiondiff_edu.performers.dance_windows import DanceWindows
from motiondiff_edu.performers.ear import Ear
from motiondiff_edu.pretrained.checkpoints import save
from motiondiff_edu.recipes import train_dancer as T
from motiondiff_edu.recipes.dancers import DANCE_RECIPES
from motiondiff_edu.recipes.ear import TrainedEar, loss_of_ear
from motiondiff_edu.recipes.songs import HeardSongs
from motiondiff_edu.recipes.train_recipe import mean_loss

MADE = Path(os.environ.get("MADE", "build/made"))
EAR_MINUTES = 89.4  # of its run


def kept_ear(recipe, folder, log=print):
    """The ear whose weights were kept, if it was made by this recipe."""
    with safe_open(Path(__file__).with_name("ear.safetensors"), "pt") as f:
        about = json.loads(f.metadata()["about"])
        weights = {k.replace("say.", "heads."): f.get_tensor(k).float() for k in f.keys()}
    wanted = json.loads(json.dumps(asdict(recipe)))
    assert {k: about[k] for k in wanted} == wanted, "another recipe"
    ear = Ear(recipe.config)
    ear.load_state_dict(weights)
    heard = HeardSongs.of(songs())
    loss = round(mean_loss(loss_of_ear(recipe, heard), ear), 6)
    size = sum(p.numel() for p in ear.parameters())
    card = {"parameters": size, "songs": len(heard), "minutes": EAR_MINUTES, "final_loss": loss}
    print(card, flush=True)
    return TrainedEar(ear, heard.scaler, card)


def songs():
    with open(MADE / "songs.pkl", "rb") as file:
        return [(song, torch.from_numpy(mel)) for song, mel in pickle.load(file)]


def danced(args):
    k, song = args
    first = DANCES_A_SEED + 2 * k
    two = (dance(song, first + j) for j in range(2))
    return [(d.positions.astype(np.float32), d.contacts) for d in two]


if __name__ == "__main__":
    name, t = sys.argv[1], time.time()
    made = songs()
    cache = MADE / "dances.pkl"
    if not cache.exists():
        with ProcessPoolExecutor(2) as pool:
            slim = [(k, song) for k, (song, _) in enumerate(made)]
            out = list(pool.map(danced, slim, chunksize=20))
        with open(cache, "wb") as file:
            pickle.dump(out, file)
        print("dances", time.time() - t, flush=True)
    if name == "data":
        sys.exit()
    with open(cache, "rb") as file:
        out = pickle.load(file)
    flat = [(p, c, mel) for (_, mel), two in zip(made, out, strict=True) for p, c in two]
    windows = DanceWindows.of(*map(list, zip(*flat, strict=True)), 100)
    del made, out, flat
    print(len(windows), flush=True)
    T.ear_of = kept_ear
    recipe = DANCE_RECIPES[name]
    if len(sys.argv) > 2:
        recipe = replace(recipe, steps=int(sys.argv[2]))
    run = MADE / f"{name}.run.safetensors"
    dancer = T.train_dancer(recipe, run, windows, log=lambda s: print(s, flush=True))
    save(dancer, MADE / f"{name}.safetensors", bits=16)
    print("done")
