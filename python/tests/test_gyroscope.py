# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A gyroscope's turns add up to how the camera is turned."""
import numpy as np
import pytest
from ovimap.gyroscope import Gyroscope
from ovimap.transforms import matrix_of, rotation_vector_of


def about(axis, angle):
    half = np.sin(angle / 2)
    return matrix_of((0, 0, 0), tuple(half * value for value in axis) + (np.cos(angle / 2),))


def truth(t):
    """Turns about two axes at once, which do not commute."""
    return about((0, 1, 0), 0.8 * np.sin(2 * t)) @ about((1, 0, 0), 0.5 * np.sin(3 * t))


def rate(t):
    return rotation_vector_of(np.linalg.inv(truth(t - 1e-4)) @ truth(t + 1e-4)) / 2e-4


def measured(start, end, rate_hz=200):
    gyroscope = Gyroscope()
    for i in range(round(start * rate_hz), round(end * rate_hz) + 1):
        gyroscope.add(i / rate_hz, rate(i / rate_hz))
    return gyroscope


def off(orientation, matrix):
    return np.linalg.norm(rotation_vector_of(np.linalg.inv(matrix_of((0, 0, 0), orientation)) @ matrix))


def test_turns_add_up_also_between_samples():
    gyroscope = measured(0, 3)
    for t in (0.0, 0.5, 1.2345, 2.9999, 3.0):
        assert off(gyroscope.at(t), truth(t)) < 2e-4
        assert np.linalg.norm(gyroscope.at(t)) == pytest.approx(1)


def test_the_camera_turns_on_a_little_after_the_last_sample():
    gyroscope = measured(0, 1)
    assert off(gyroscope.at(1.015), truth(1.015)) < 1e-3
    assert gyroscope.at(1.03) is None and gyroscope.at(-0.001) is None and Gyroscope().at(0.0) is None


def test_what_is_long_ago_is_forgotten_and_what_is_kept_stays_right():
    gyroscope = measured(0, 30, rate_hz=100)
    assert gyroscope.at(10.0) is None and len(gyroscope._times) <= 1001
    turned = matrix_of((0, 0, 0), gyroscope.at(26.0))
    assert off(gyroscope.at(29.0), turned @ np.linalg.inv(truth(26.0)) @ truth(29.0)) < 1e-3


@pytest.mark.parametrize("then", [50.0, -50.0, 1.5])
def test_a_clock_that_jumps_begins_anew(then):
    gyroscope = measured(0, 1)
    gyroscope.add(then, (0.1, 0.0, 0.0))
    assert gyroscope.at(0.9) is None and gyroscope.at(then) is not None
    gyroscope.add(then + 0.005, (0.1, 0.0, 0.0))
    turn = np.linalg.inv(matrix_of((0, 0, 0), gyroscope.at(then))) @ matrix_of((0, 0, 0), gyroscope.at(then + 0.005))
    assert rotation_vector_of(turn) == pytest.approx([0.0005, 0, 0], abs=1e-9)
