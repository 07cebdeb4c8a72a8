"""Wrong answers to the exercises of notebook 10."""

import torch


def order_only(control):
    """Does what the paper says: the control still leads ahead while time runs backwards."""
    return control.flip(1)


def not_shifted(control):
    """Each step comes one frame too early, so the path ends near its start, but not at it."""
    return -control.flip(1)


def no_sign(control):
    """The rows are in the right order, but the figure still walks ahead."""
    back = control[:, :-1].flip(1)
    return torch.cat([back, back[:, -1:]], dim=1)


def yaw_kept(control):
    """The figure walks backwards, and turns to the wrong side."""
    return -no_sign(control) * torch.tensor([1, 1, -1.0])


def left_kept(control):
    """The figure walks backwards, and steps to the wrong side."""
    return -no_sign(control) * torch.tensor([1, -1.0, 1])


def last_kept(factor):
    """Ends with the row that leads nowhere, times this: at 0 the figure stands still."""

    def answer(control):
        return torch.cat([-control[:, :-1].flip(1), factor * control[:, -1:]], dim=1)

    return answer


def first_dropped(control):
    """Drops the first row, which leads out of frame 0, and keeps the last, which leads nowhere."""
    back = -control[:, 1:].flip(1)
    return torch.cat([back, back[:, -1:]], dim=1)


def first_repeated(control):
    """Repeats the first row of the result where the last belongs."""
    back = -control[:, :-1].flip(1)
    return torch.cat([back[:, :1], back], dim=1)


def in_place(control):
    """The numbers are right, but the given control is changed."""
    control.copy_(-no_sign(control))
    return control


def _reversed(control):
    return -no_sign(control)


def _round(walk_on, past, known, mean, control, reverse=_reversed, flip_ahead=True, flip_back=True):
    filled = torch.where(known, past, mean)
    ahead = walk_on(filled, control)
    back = walk_on(ahead.flip(1) if flip_ahead else ahead, reverse(control))
    return back.flip(1) if flip_back else back


def _filled(reverse=_reversed, flip_ahead=True, flip_back=True):
    how = (reverse, flip_ahead, flip_back)

    def answer(walk_on, past, known, mean, control):
        return torch.where(known, past, _round(walk_on, past, known, mean, control, *how))

    return answer


def mask_inverted(walk_on, past, known, mean, control):
    """Keeps the holes and replaces what was given."""
    return torch.where(
        known, _round(walk_on, past, known, mean, control), torch.where(known, past, mean)
    )


def raw_zero(walk_on, past, known, mean, control):
    """The missing hand starts on the floor, and the walker uses it like a given one."""
    return torch.where(known, past, _round(walk_on, past, known, torch.zeros_like(mean), control))


def nan_to_the_walker(walk_on, past, known, mean, control):
    """Fills the holes only afterwards: the walker has computed with NaN."""
    return torch.where(known, past, _round(walk_on, past, known, past, control))


def start_returned(walk_on, past, known, mean, control):
    """Walks there and back, and does not use the result."""
    _round(walk_on, past, known, mean, control)
    return torch.where(known, past, mean)


def two_rounds(walk_on, past, known, mean, control):
    """Makes two rounds instead of one."""
    once = torch.where(known, past, _round(walk_on, past, known, mean, control))
    return torch.where(known, past, _round(walk_on, once, known, mean, control))


def short_control(walk_on, past, known, mean, control):
    """Gives only the control of the past; the walker has none for the new frames."""
    ahead = walk_on(torch.where(known, past, mean), control[:, : past.shape[1]])
    back = walk_on(ahead.flip(1), -no_sign(control)).flip(1)
    return torch.where(known, past, back)


def last_pose_only(walk_on, past, known, mean, control):
    """Walks back from one pose; the walker needs as many as it was trained with."""
    ahead = walk_on(torch.where(known, past, mean), control)
    back = walk_on(ahead.flip(1)[:, -1:], -no_sign(control)).flip(1)
    return torch.where(known, past, back)


def there_only(walk_on, past, known, mean, control):
    """Fills the past with the future."""
    return torch.where(known, past, walk_on(torch.where(known, past, mean), control))


def by_product(walk_on, past, known, mean, control):
    """Multiplies by the mask: 0 times NaN is NaN."""
    back = _round(walk_on, past, known, mean, control)
    return known * past + ~known * back


def past_in_place(walk_on, past, known, mean, control):
    """The right past, written over the given one."""
    past[:] = torch.where(known, past, _round(walk_on, past, known, mean, control))
    return past


def _change(before, after, known):
    return (after - before).square() * ~known


def _holes(known):
    return (~known).flatten(1).sum(1).clamp(min=1)


def _known_only(before, after, known):
    moved = (after - before).square() * known
    return (moved.flatten(1).sum(1) / known.flatten(1).sum(1).clamp(min=1)).sqrt()


def mean_distance(before, after, known):
    """Gives the mean distance, not the root of the mean square."""
    return ((after - before).abs() * ~known).flatten(1).sum(1) / _holes(known)


def before_in_place(before, after, known):
    """The numbers are right, but the old values of the holes are lost."""
    before -= after
    return ((before.square() * ~known).flatten(1).sum(1) / _holes(known)).sqrt()


def after_in_place(before, after, known):
    """The numbers are right, but the new values are changed."""
    after[known] = before[known]
    return ((after - before).square().flatten(1).sum(1) / _holes(known)).sqrt()


def nothing_by_nothing(before, after, known):
    """Divides 0 by 0 when nothing is missing: NaN is below no tolerance, and the loop runs on."""
    return (_change(before, after, known).flatten(1).sum(1) / (~known).flatten(1).sum(1)).sqrt()


MISTAKES = {
    "time_reversal": {
        "only the order is reversed; a walk backwards has a negative speed": order_only,
        "the signs are right; but control[t] leads from t to t + 1, so the rows move by one": (
            not_shifted
        ),
        "order and shift are right, the signs are not": no_sign,
        "turning has a sign, too: a left turn is a right turn on the way back": yaw_kept,
        "speed to the left has a sign, too": left_kept,
        "speed ahead has a sign, too": lambda control: (
            -no_sign(control) * torch.tensor([-1, 1, 1.0])
        ),
        "the last row repeats the one before, it is not zero": last_kept(0),
        "the last row given leads nowhere: instead of it the row before repeats": (
            last_kept(-1),
            last_kept(1),
        ),
        "the signs are right, but the rows are in the old order": lambda control: -control,
        "nothing has changed": lambda control: control.clone(),
        "the sample axis was reversed; time is axis 1": lambda control: _reversed(control).flip(0),
        "the columns were reversed; time is axis 1": lambda control: -control.flip(2),
        "the wrong end was dropped: the last row leads nowhere, the first one out of frame 0": (
            first_dropped
        ),
        "the wrong end was repeated: the last row of the result stands twice": first_repeated,
    },
    "there_and_back": {
        "the control is reversed in order only; its signs must change": _filled(reverse=order_only),
        "the control is negated, but not shifted by its one frame": _filled(reverse=not_shifted),
        "the control is reversed and shifted; its signs must change, too": _filled(reverse=no_sign),
        "the control of the way back is that of the way there": _filled(
            reverse=lambda control: control
        ),
        "turning (column 2) keeps its sign on your way back": _filled(reverse=yaw_kept),
        "the new frames are not reversed before they go into the walker again": _filled(
            flip_ahead=False
        ),
        "the result of the way back is reversed in time; reverse it before you fill": _filled(
            flip_back=False
        ),
        "time was never reversed: walking on twice leads farther ahead": _filled(
            flip_ahead=False, flip_back=False
        ),
        "neither time nor the control was reversed: walking on twice leads farther ahead": _filled(
            reverse=lambda control: control, flip_ahead=False, flip_back=False
        ),
        "the mask is inverted: known is True where something was given": mask_inverted,
        "the given entries are overwritten by the walker's": _round,
        "holes start at 0 metres, which is on the floor; start them at the mean pose": raw_zero,
        "the holes still have their starting values": start_returned,
        "this fills the past with the way there; the way back is missing": there_only,
        "there is NaN in the holes: the walker got NaN, or 0 times NaN was added; fill the holes "
        "first, and choose with torch.where": (nan_to_the_walker, by_product),
    },
    "moved_by": {
        "that is the mean of squares; take its root": lambda before, after, known: (
            _change(before, after, known).flatten(1).sum(1) / _holes(known)
        ),
        "known entries are counted, too; measure only the holes": lambda before, after, known: (
            (after - before).square().flatten(1).mean(1).sqrt()
        ),
        "the known entries were measured instead of the holes": _known_only,
        "this is divided by the number of all entries; divide by the number of holes": (
            lambda before, after, known: _change(before, after, known).flatten(1).mean(1).sqrt()
        ),
        "this is one number for all samples; return one for each": lambda before, after, known: (
            (after - before)[~known].square().mean().sqrt()
        ),
        "that is the mean distance; the rule takes the root of the mean square": mean_distance,
        "that is the root of the sum; divide by the number of holes first": (
            lambda before, after, known: _change(before, after, known).flatten(1).sum(1).sqrt()
        ),
        "the root is of the mean; this divides after the root": lambda before, after, known: (
            _change(before, after, known).flatten(1).sum(1).sqrt() / _holes(known)
        ),
        "where nothing is missing the change is 0; yours is 0 / 0": nothing_by_nothing,
        "this is the largest change; take the root of the mean square": (
            lambda before, after, known: (
                _change(before, after, known).flatten(1).max(1).values.sqrt()
            )
        ),
    },
}
OTHERS = {
    "time_reversal": {"changes its input": in_place},
    "there_and_back": {
        "two rounds": two_rounds,
        "control of the past only": short_control,
        "back from one pose": last_pose_only,
        "past in place": past_in_place,
    },
    "moved_by": {"changes before": before_in_place, "changes after": after_in_place},
}
