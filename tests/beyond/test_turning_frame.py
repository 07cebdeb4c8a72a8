"""The frame of a turning figure: headings by hand, there and back, and no figure that shrinks."""

import numpy as np
import pytest
import torch
from gaits import rest_pose

from data_synth.walking import random_control, walk
from motiondiff_edu.beyond.around_lines import GivenLines
from motiondiff_edu.beyond.turning_frame import SPAN, STEP, TurningFrame, headings
from motiondiff_edu.editing.masks import body_part, keyframes
from motiondiff_edu.motion.dance_frame import PATH, Place, placed_features, to_positions
from motiondiff_edu.motion.known import known_columns
from motiondiff_edu.motion.skeleton import TOES, joint_index

T = 41
LEFT, RIGHT = joint_index("LeftUpLeg"), joint_index("RightUpLeg")


def turning(angles: np.ndarray) -> np.ndarray:
    """The rest pose in every frame, facing these angles (radians)."""
    return np.stack([Place(np.zeros(3), np.array(a)).leave(rest_pose()[None])[0] for a in angles])


def features_of(positions: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(placed_features(positions))[None]


def masks(known: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(known)[None]


def columns(known: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(known_columns(known))[None]


def test_headings_are_as_given_and_turn_evenly_between_the_short_way_round():
    angles = np.linspace(0.0, 5.0, T)  # with steps of less than a half circle between keyframes
    found = headings(features_of(turning(angles)), masks(keyframes(T, 10)))[0]
    np.testing.assert_allclose(found, angles, atol=1e-6)
    back = headings(features_of(turning(np.linspace(3.0, 3.6, T))), masks(keyframes(T, 20)))[0]
    np.testing.assert_allclose(back, np.linspace(3.0, 3.6, T), atol=1e-6)


def test_shoulders_tell_it_without_hips_and_nobody_tells_it_without_both():
    positions, known = turning(np.linspace(0.2, 1.0, T)), keyframes(T, 10)
    known[:, [LEFT, RIGHT]] = False
    found = headings(features_of(positions), masks(known))[0]
    np.testing.assert_allclose(found, np.linspace(0.2, 1.0, T), atol=1e-6)
    known[:, joint_index("LeftArm")] = False
    assert (headings(features_of(positions), masks(known)) == 0).all()
    once = np.zeros((T, 21), bool)
    once[7] = True
    stays = headings(features_of(positions), masks(once))[0]
    np.testing.assert_allclose(stays, np.full(T, np.linspace(0.2, 1.0, T)[7]), atol=1e-6)


def test_a_twisted_trunk_does_not_make_the_heading_jump():
    """With the upper body and keyframes given, hips are given in keyframes alone."""
    positions = turning(np.linspace(0.0, 1.0, T))
    twist, chest = np.radians(30.0), [j for j in range(9, 21)]
    x, z = positions[:, chest, 0].copy(), positions[:, chest, 2].copy()
    positions[:, chest, 0] = x * np.cos(twist) + z * np.sin(twist)
    positions[:, chest, 2] = z * np.cos(twist) - x * np.sin(twist)
    known = keyframes(T, 10) | body_part(T, "upper body")
    found = headings(features_of(positions), masks(known))[0].numpy()
    np.testing.assert_allclose(found, np.linspace(0.0, 1.0, T) + twist, atol=1e-5)
    legs = keyframes(T, 10) | body_part(T, "lower body")
    found = headings(features_of(positions), masks(legs))[0].numpy()
    np.testing.assert_allclose(found, np.linspace(0.0, 1.0, T), atol=1e-5)


def test_to_enter_and_to_leave_are_inverse_and_a_turning_figure_stands_still_inside():
    features = features_of(turning(np.linspace(0.0, 2.5, T)))
    frame = TurningFrame.of(features, masks(keyframes(T, 10)))
    inside = frame.enter(features)
    torch.testing.assert_close(inside, features[:, :1].expand_as(inside), atol=1e-6, rtol=0)
    torch.testing.assert_close(frame.leave(inside), features)
    nothing = TurningFrame.none(features)
    assert torch.equal(nothing.enter(features), features)


def test_a_figure_that_turns_round_keeps_its_hips_apart():
    """With lines in the frame of the first pose they would pass through each other."""
    positions, known = turning(np.linspace(0.0, 0.95 * np.pi, T)), keyframes(T, T - 1)
    features, seen = features_of(positions), columns(known)

    def narrowest(frame: TurningFrame) -> float:
        lines = GivenLines.of(frame.enter(features), seen, frame).lines
        made = to_positions(frame.leave(lines))[0]
        return float((made[:, LEFT] - made[:, RIGHT]).norm(dim=-1).min())

    width = np.linalg.norm(positions[0, LEFT] - positions[0, RIGHT])
    assert narrowest(TurningFrame.of(features, masks(known))) == pytest.approx(width, abs=1e-6)
    assert narrowest(TurningFrame.none(features)) < 0.1 * width


def test_steps_are_the_speed_of_a_toe_from_place_to_place_in_the_heading():
    """One toe stays, the other goes half a metre to where the figure, turned, looks."""
    angle = 0.6
    positions = turning(np.full(T, angle))
    positions[:, TOES[1]] += np.linspace(0, 0.5, T)[:, None] * [np.sin(angle), 0, np.cos(angle)]
    steps = TurningFrame.of(features_of(positions), masks(keyframes(T, T - 1))).steps[0]
    wanted = torch.tensor([0, 0, 0, 0, 0, 0.5 * 2 * SPAN / (T - 1) / STEP], dtype=torch.float64)
    torch.testing.assert_close(steps, wanted.expand(T, 6), atol=1e-6, rtol=1e-6)


def test_the_network_sees_the_same_whichever_way_a_figure_turned_before():
    """Headings, path and poses of a walk's last second, behind another first frame."""
    walked = walk(random_control(5.0, np.random.default_rng(0), "turn"), 0).world()
    clip, known = walked[:T], keyframes(T, 5)
    views = []
    for angle in (0.0, 2.0):
        turned = Place(np.array([0.3, 0.0, -1.0]), np.array(angle)).enter(clip)
        features = features_of(turned)
        frame = TurningFrame.of(features, masks(known))
        shown = GivenLines.of(frame.enter(features), columns(known), frame)
        views.append(shown.speeds())
    torch.testing.assert_close(views[0], views[1], atol=1e-5, rtol=1e-5)
    assert views[0][..., PATH].abs().max() > 0.1


def test_what_is_generated_of_the_path_is_turned_and_comes_back():
    walked = walk(random_control(3.0, np.random.default_rng(1), "turn"), 0).world()[:T]
    known = keyframes(T, 10)
    features, seen = features_of(walked), columns(known)
    frame = TurningFrame.of(features, masks(known))
    inside = frame.enter(features)
    shown, plain = GivenLines.of(inside, seen, frame), GivenLines.of(inside, seen)
    remainder = shown.remainder(inside)
    torch.testing.assert_close(shown.whole(remainder), inside)
    torch.testing.assert_close(
        remainder[..., PATH].norm(dim=-1), plain.remainder(inside)[..., PATH].norm(dim=-1)
    )
    assert not torch.allclose(remainder[..., PATH], plain.remainder(inside)[..., PATH], atol=1e-3)
