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


def last_zero(control):
    """The figure stands still in the last frame."""
    back = -control[:, :-1].flip(1)
    return torch.cat([back, torch.zeros_like(back[:, :1])], dim=1)


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
    def answer(walk_on, past, known, mean, control):
        how = (reverse, flip_ahead, flip_back)
        return torch.where(known, past, _round(walk_on, past, known, mean, control, *how))

    return answer


def mask_inverted(walk_on, past, known, mean, control):
    """Keeps the holes and replaces what was given."""
    return torch.where(
        known, _round(walk_on, past, known, mean, control), torch.where(known, past, mean)
    )


def overwritten(walk_on, past, known, mean, control):
    """The past is smooth, but it is no longer the given one."""
    return _round(walk_on, past, known, mean, control)


def raw_zero(walk_on, past, known, mean, control):
    """The missing hand starts on the floor, and the walker uses it like a given one."""
    return torch.where(known, past, _round(walk_on, past, known, torch.zeros_like(mean), control))


def nan_to_the_walker(walk_on, past, known, mean, control):
    """Fills the holes only afterwards: the walker has computed with NaN."""
    return _round(walk_on, past, known, past, control)


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


def _moved(before, after, known):
    return (after - before).square() * ~known, (~known).flatten(1).sum(1).clamp(min=1)


def no_root(before, after, known):
    """Gives square metres: a centimetre becomes 0.0001."""
    moved, holes = _moved(before, after, known)
    return moved.flatten(1).sum(1) / holes


def all_entries(before, after, known):
    """Given entries count as well."""
    return (after - before).square().flatten(1).mean(1).sqrt()


def divided_by_all(before, after, known):
    """A small hole seems to stop changing long before it does."""
    return _moved(before, after, known)[0].flatten(1).mean(1).sqrt()


def one_for_all(before, after, known):
    """Gives one number for the whole batch, which hides one sample that still moves."""
    return (after - before)[~known].square().mean().sqrt()


def mean_distance(before, after, known):
    """Gives the mean distance, not the root of the mean square."""
    holes = ~known
    return ((after - before).abs() * holes).flatten(1).sum(1) / holes.flatten(1).sum(1).clamp(min=1)


def before_in_place(before, after, known):
    """The numbers are right, but the old values of the holes are lost."""
    before -= after
    moved = before.square() * ~known
    return (moved.flatten(1).sum(1) / (~known).flatten(1).sum(1).clamp(min=1)).sqrt()


def after_in_place(before, after, known):
    """The numbers are right, but the new values are changed."""
    after[known] = before[known]
    return (
        ((after - before).square()).flatten(1).sum(1) / (~known).flatten(1).sum(1).clamp(min=1)
    ).sqrt()


def nothing_by_nothing(before, after, known):
    """Divides 0 by 0 when nothing is missing: NaN is below no tolerance, and the loop runs on."""
    holes = ~known
    return (((after - before).square() * holes).flatten(1).sum(1) / holes.flatten(1).sum(1)).sqrt()


ZOO = {
    "time_reversal": {
        "order only": order_only,
        "negated, not shifted": not_shifted,
        "shifted, not negated": no_sign,
        "yaw keeps its sign": yaw_kept,
        "left keeps its sign": left_kept,
        "last row zero": last_zero,
        "changes its input": in_place,
    },
    "there_and_back": {
        "control not negated": _filled(reverse=order_only),
        "negated, not shifted": _filled(reverse=not_shifted),
        "motion reversed, control not": _filled(reverse=lambda control: control),
        "yaw not negated": _filled(reverse=yaw_kept),
        "new frames not reversed": _filled(flip_ahead=False),
        "way back not turned round": _filled(flip_back=False),
        "mask inverted": mask_inverted,
        "known entries overwritten": overwritten,
        "holes start at raw zero": raw_zero,
        "NaN given to the walker": nan_to_the_walker,
        "start returned": start_returned,
        "two rounds": two_rounds,
        "control of the past only": short_control,
        "back from one pose": last_pose_only,
        "way there only": there_only,
        "time never turned": _filled(flip_ahead=False, flip_back=False),
        "neither time nor control turned": _filled(
            reverse=lambda control: control, flip_ahead=False, flip_back=False
        ),
    },
    "moved_by": {
        "no root": no_root,
        "all entries count": all_entries,
        "divided by all entries": divided_by_all,
        "one number for all samples": one_for_all,
        "mean distance": mean_distance,
        "changes before": before_in_place,
        "changes after": after_in_place,
        "nothing by nothing": nothing_by_nothing,
    },
}
