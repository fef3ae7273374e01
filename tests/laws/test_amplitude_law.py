"""Large motion and friction as causes of frequencies that change with amplitude: hidden in rows, and found."""

from dataclasses import replace

import numpy as np
import pytest

from cdpr_struct.diagnosis.amplitude_law import held_out_rms, weighed
from cdpr_struct.diagnosis.amplitude_rows import BOTH, FRAME, PLATFORM_ENDS, AmplitudeRows
from cdpr_struct.dynamics.large_motion import LargeMotion
from cdpr_struct.dynamics.presliding_friction import end_turns
from cdpr_struct.reports.diagnose.amplitudes import amplitude_sentence
from tests.large_motion_robots import three_cables

RECORDS, WINDOWS, SIGMA = 5, 3, 3e-4


@pytest.fixture(scope="module")
def rows() -> AmplitudeRows:
    """Three modes in three windows of five decays that begin with 10 to 60 mm; no change of frequency yet."""
    point, rng = three_cables(), np.random.default_rng(5)
    motion = LargeMotion.about(point)
    reach = np.array([motion.reach(k) for k in range(3)])
    first = rng.uniform(0.01, 0.06, (RECORDS, 1, 3))
    meters = (first * np.array([1.0, 0.6, 0.35])[None, :, None]).reshape(-1, 3)
    turns = end_turns(point, motion.shapes[:, :3].T)
    tension = np.concatenate([point.cables.tension_at_frame, point.cables.tension_at_platform])
    count = RECORDS * WINDOWS
    motions = (
        np.broadcast_to(turns, (count, *turns.shape)), np.tile(motion.omega[:3], (count, 1)), meters / reach,
    )  # fmt: skip
    order = [(r * WINDOWS + w, k) for r in range(RECORDS) for k in range(3) for w in range(WINDOWS)]
    place = np.array(order)
    record = place[:, 0] // WINDOWS
    large = (meters**2 @ motion.leading([0, 1, 2]).T)[place[:, 0], place[:, 1]]
    size = np.full(len(place), SIGMA)
    return AmplitudeRows(
        tuple(f"r{r}" for r in record), record, 100 * record + place[:, 1], np.zeros(len(place)), size,
        np.full(len(place), 0.005), size, meters[place[:, 0], place[:, 1]], large, motions,
        np.tile(tension, (count, 1)), place,
    )  # fmt: skip


def recorded(rows, radius, angle, ends):
    """What decays with that friction read, noise on."""
    rng, (shift, damping) = np.random.default_rng(8), rows.friction(np.array([angle]))
    return replace(
        rows,
        log_hertz=rows.large + radius * shift[ends][0] + SIGMA * rng.normal(size=len(rows)),
        damping=rows.damping + radius * damping[ends][0] + SIGMA * rng.normal(size=len(rows)),
    )


def test_large_motion_alone_is_found_and_no_friction(rows):
    found = weighed(recorded(rows, 0.0, 0.005, BOTH), 0.0)
    assert found.status == "large_motion"
    assert found.large_gain > 20.0
    assert found.fits[0].gain < 3.0


def test_friction_is_found_with_its_sizes_and_predicts_records_that_it_was_not_fitted_to(rows):
    """0.2 mm over 0.3 degrees at the platform ends, in steps of the grids: factors of 1.12 and 1.8."""
    angle = float(np.deg2rad(0.3))
    found = weighed(recorded(rows, 2e-4, angle, PLATFORM_ENDS), 0.0)
    best = next(fit for fit in found.fits if len(fit.parts) == 1)
    assert found.status == "friction"
    (part,) = best.parts
    assert part.ends in (PLATFORM_ENDS, BOTH)  # frame ends turn five times less and hardly count
    assert part.radius[1] / 1.3 < 2e-4 < part.radius[2] * 1.3
    assert part.angle[1] / 1.8 < angle < part.angle[2] * 1.8
    own = found.rows
    assert held_out_rms(own, own.large + best.held_out) < 0.5 * held_out_rms(own, own.large)
    assert "with dry friction at" in amplitude_sentence(found)


@pytest.mark.slow
def test_where_friction_acts_is_told_apart(rows):
    found = weighed(recorded(rows, 2e-3, 0.01, FRAME), 0.0)
    gain = {fit.parts[0].ends: fit.gain for fit in found.fits if len(fit.parts) == 1}
    assert gain[FRAME] > gain[BOTH] + 5.0
    assert gain[FRAME] > gain[PLATFORM_ENDS] + 5.0


def test_a_record_has_no_say_in_its_own_prediction(rows):
    """What one record read is changed by ten sigmas: predictions of it by the others stay, those of others do not."""
    told = recorded(rows, 2e-4, 0.005, PLATFORM_ENDS)
    first = told.record == 0
    other = replace(told, log_hertz=told.log_hertz + np.where(first, 3e-3 * np.arange(len(told)) % 7e-3, 0.0))
    before, after = (
        next(fit for fit in weighed(each, 0.0).fits if fit.parts[0].ends == BOTH).held_out for each in (told, other)
    )
    np.testing.assert_allclose(after[first], before[first], rtol=1e-9)
    assert np.abs(after[~first] / before[~first] - 1.0).max() > 1e-3
