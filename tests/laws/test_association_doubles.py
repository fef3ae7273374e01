"""Close modes leave fewer peaks than two apart."""

import numpy as np
import pytest

from cdpr_struct.association.association import Association
from cdpr_struct.association.detection import LEAST_RELATIVE_DETECTION, clutter, robot_detection
from cdpr_struct.association.doubles import detection_of_doubles
from cdpr_struct.association.modes import robot_modes
from cdpr_struct.association.peaks import PeakList, padded


def test_coincident_modes_leave_the_peaks_of_their_union():
    detection = np.array([[0.8, 0.6, 0.9]])
    close = detection_of_doubles(np.log([[10.0, 10.0, 20.0]]), detection)
    assert close[0, :2].sum() == pytest.approx(1.0 - 0.2 * 0.4)
    assert close[0, 2] == pytest.approx(0.9)
    np.testing.assert_allclose(detection_of_doubles(np.log([[8.0, 10.0, 20.0]]), detection), detection)


def test_invisible_neighbour_takes_nothing_away():
    detection = np.array([[0.8, 0.0]])
    np.testing.assert_array_equal(detection_of_doubles(np.log([[10.0, 10.0]]), detection), detection)


def test_one_peak_of_a_double_is_more_probable_and_two_are_less():
    modes, detection = np.log([[10.0, 10.03]]), np.array([[0.85, 0.85]])
    found = {}
    for count, seen in ((1, [10.015]), (2, [9.99, 10.04])):
        peaks = padded([PeakList(seen, np.full(count, 0.003), (2.0, 60.0))])
        for name, p in (("apart", detection), ("merged", detection_of_doubles(modes, detection))):
            association = Association(peaks, robot_modes(modes, p), clutter(peaks))
            association.expect(np.zeros((1, 2)), np.zeros((1, 2)))
            found[count, name] = association.assignment.matching.log_likelihood[0]
    assert found[1, "merged"] > found[1, "apart"] + 0.5
    assert found[2, "merged"] < found[2, "apart"] - 0.5


def test_detection_rises_with_the_share_and_never_leaves_its_bounds():
    detection = robot_detection(np.linspace(0.0, 1.0, 101))
    assert (np.diff(detection) >= 0.0).all()
    assert detection[0] == pytest.approx(0.9 * LEAST_RELATIVE_DETECTION)
    assert detection[-1] == pytest.approx(0.9)


def test_a_steady_line_makes_a_peak_there_cheap():
    peaks = padded([PeakList([50.02, 47.0], [0.003, 0.003], (2.0, 60.0))])
    plain, line = clutter(peaks), clutter(peaks, lines=np.array([50.0, 100.0]))
    assert line.density[0, 0] > 50.0 * plain.density[0, 0]
    assert line.density[0, 1] == pytest.approx(plain.density[0, 1], rel=1e-6)
    assert line.expected - plain.expected == pytest.approx(0.5)  # 100 Hz lies outside the band
