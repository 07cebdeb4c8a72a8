"""Control from joysticks and constants."""

import numpy as np
import pytest

from motiondiff_edu.conditions.control import as_long, constant_control, joystick, splice


def test_a_constant_control_is_the_same_in_all_rows():
    control = constant_control(1, 0.5, -0.25, seconds=2)
    assert control.shape == (40, 3) and np.array_equal(control[7], [1, 0.5, -0.25])


def test_a_spliced_control_leads_into_the_first_new_frame():
    past = constant_control(1.0, seconds=0.6)
    new = constant_control(0.0, 0.5, 0.2, seconds=0.2)
    before = past.copy()
    rows = splice(past, new, T_h=5)
    assert rows.tolist() == [[1.0, 0.0, 0.0]] * 4 + [[0.0, 0.5, 0.2]] * 5
    assert np.array_equal(past, before)
    with pytest.raises(ValueError, match="13 past frames; this past has 12"):
        splice(past, new, T_h=13)


def test_a_control_has_the_columns_of_its_network():
    rows = np.arange(8.0).reshape(2, 4)
    longer = as_long(rows, 5, columns=4)
    assert longer.shape == (5, 4) and np.array_equal(longer[[0, 4]], rows)
    with pytest.raises(ValueError, match=r"is \(rows, 3\): .*, turning rad/s, 20 rows .* \(2, 4\)"):
        as_long(rows, None)
    with pytest.raises(ValueError, match=r"is \(rows, 4\): .*, 1 of your own, 20 rows .* \(2, 3\)"):
        as_long(rows[:, :3], None, columns=4)
    millimetres = np.array([[1.0, 0.0, 0.0, 1200.0]])
    assert as_long(millimetres, 2, columns=4)[1, 3] == 1200, "a unit of one's own"
    with pytest.raises(ValueError, match="row 0 of the control"):
        as_long(millimetres * [1, 1, 1, np.inf], None, columns=4)


def test_joystick_reaches_each_target_smoothly():
    control = joystick([(1, 0, 0, 0), (2, 1.2, 0, 0), (1.5, 1.2, -0.3, 0.8)])
    assert control.shape == (90, 3)
    assert np.array_equal(control[19], [0, 0, 0]) and np.allclose(control[29], [1.2, 0, 0])
    assert np.allclose(control[-1], [1.2, -0.3, 0.8])
    assert np.all(np.diff(control[:, 0]) >= 0) and np.diff(control[:, 0]).max() < 0.2
    assert np.isclose(control[24, 0], 0.6)  # half way after half of the half second
