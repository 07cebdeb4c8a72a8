"""The README's moving picture: the shipped walker along the slalom.

Run: python tools/walk_gif.py
"""

from pathlib import Path

import numpy as np
import torch

from data_synth.walking import walk
from motiondiff_edu import rollout
from motiondiff_edu.conditions.control import constant_control, splice
from motiondiff_edu.motion.root_frame import root_path, to_world
from motiondiff_edu.pretrained import checkpoints
from motiondiff_edu.widgets.path import PathPad
from motiondiff_edu.widgets.player import Player

OUT = Path(__file__).parents[1] / "docs" / "walk.gif"


def main() -> None:
    standing = walk(constant_control(seconds=2), seed=1, style="neutral")
    ahead = PathPad(preset="slalom").control()[:130]
    control = splice(standing.control, ahead, 10)
    past = torch.from_numpy(standing.features()[-10:])
    new = rollout.generate(
        checkpoints.pretrained("walker"), past, torch.tensor(control, dtype=torch.float32), seed=0
    )
    poses = np.concatenate([standing.poses[-10:], new.double().numpy().reshape(-1, 21, 3)])
    player = Player(to_world(poses, control), past=10, path=root_path(control)[0])
    print("written:", player.save_gif(OUT, (420, 320)))


if __name__ == "__main__":
    main()
