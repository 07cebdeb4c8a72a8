"""The loss of a network that sees what is given of a motion: eq. 4 of the remainder.

Every motion of a batch gets a mask of its own (`drawn_masks`). Kinematic losses are those of the
whole motion, lines and remainder together. Errors are weighted as those of the whole motion, so
that the middle of a gap counts more than its ends; and motions count alike, whatever is given. At
every step they count as errors of x0, also where the network predicts v.
"""

from dataclasses import replace

import torch
from jaxtyping import Bool, Float
from torch import Tensor, nn

from ..beyond.around_lines import Shown
from ..beyond.loss_terms import as_x0_errors, weighted, weighted_by_step
from ..ddpm import Schedule
from ..editing.inbetween import seen_from
from ..kinematic_loss import Body
from ..motion import dance_frame
from ..motion.scaler import Scaler
from ..performers.dance_windows import DanceWindows, toes_moved
from ..training import LossFn
from .dancers import KeyframeRecipe
from .drawn_masks import drawn_masks, uniform
from .mofusion_loss import batch_loss, weighted_loss


def keyframe_loss_of(recipe: KeyframeRecipe, windows: DanceWindows, schedule: Schedule) -> LossFn:
    """The loss of a recipe whose network is `KeyframeMoFusion`."""
    scaler = windows.motion_scaler
    data_loss = weighted_loss(
        recipe.loss_weights, schedule, scaler, dance_frame.moves, lambda: toes_moved(windows)
    )
    if recipe.config.target == "v":
        data_loss = weighted_by_step(data_loss, as_x0_errors(schedule))

    def loss_fn(model: nn.Module, generator: torch.Generator) -> Tensor:
        device = next(model.parameters()).device
        motion, _, planted = windows.draw(recipe.batch, generator)
        known = drawn_masks(len(motion), windows.n, generator)
        sizes = 1 + recipe.sizes * (2 * uniform(generator, len(motion)) - 1)
        high = (uniform(generator, len(motion)) < recipe.stages) & known.flatten(1).any(1)
        heights = high * uniform(generator, len(motion))
        motion = as_seen(scaler.inverse(motion), known, sizes, heights)
        view = model.view(motion, known)
        motion = scaler.transform(view.enter(motion)).to(device)
        columns = known.repeat_interleave(3, dim=-1).to(device)
        shown = model.shown(motion, columns, view.to(device))
        squares = shown.scale.square()
        loss = weighted(data_loss, squares / squares.mean((1, 2), keepdim=True))
        of_batch = batch_loss(
            recipe.kinematic, loss, schedule, scaler, lambda s: body_around(shown, s)
        )
        return of_batch(model, shown.remainder(motion), shown, planted.to(device), generator)

    return loss_fn


def as_seen(
    motion: Float[Tensor, "B T 63"],
    known: Bool[Tensor, "B T 21"],
    sizes: Float[Tensor, "B"],
    heights: Float[Tensor, "B"],
) -> Float[Tensor, "B T 63"]:
    """Motions (features in metres) as `inbetween` shows them, from their first given pose.

    They are resized, and stand on stages of these heights (m).
    """
    positions = dance_frame.to_positions(motion).double().numpy()
    masks = known.numpy()
    drawn = zip(positions, masks, sizes.tolist(), heights.tolist(), strict=True)
    for one, mask, size, height in drawn:
        one[:] = size * seen_from(one, mask).enter(one) + [0.0, height, 0.0]
    return torch.from_numpy(dance_frame.placed_features(positions)).float()


def body_around(shown: Shown, scaler: Scaler) -> Body:
    """The figure of remainders: their joints in metres are those of lines and remainder."""

    def to_positions(remainder: Float[Tensor, "B T 63"]) -> Float[Tensor, "B T 21 3"]:
        motion = scaler.inverse(shown.whole(remainder))
        return dance_frame.to_positions(shown.view.leave(motion) if shown.view else motion)

    return replace(dance_frame.body_of(scaler), to_positions=to_positions)
