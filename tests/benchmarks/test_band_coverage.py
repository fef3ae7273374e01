"""The study of bands: its true robots are as tolerances say, the FEM moves as predicted, and wrong bands are seen."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import chi2

import cdpr_struct as cs
import cdpr_struct.fem_reference as fem
from benchmarks import seed_runs
from benchmarks.band_coverage import running
from benchmarks.band_coverage.drawing import FEW, Case, drawn
from benchmarks.band_coverage.fem_rest import SURE, FemRest, fem_rest
from benchmarks.band_coverage.prediction import Prediction, predicted
from benchmarks.band_coverage.summary import QUANTITIES, faults, limits, summary
from benchmarks.band_coverage.true_robot import drawn_true_robot
from benchmarks.band_coverage.trying import compared
from cdpr_struct.bands.mode_rates import mode_rates
from cdpr_struct.interface.bands import AskedBand, Banded
from cdpr_struct.robot.tolerances import Tolerances, tolerance_factor

SEEDS = {"built-in": 7, "random, 6 to 12 cables": 13, "random, pulleys": 6, FEW: 27}


def numbers_off(robot: cs.Robot, lengths: np.ndarray, true: fem.RobotData) -> np.ndarray:
    """By how much a true robot's numbers are off, in the order and units of the program's table of them."""
    m, body = len(robot.cables), true.platform
    length, stiff, heavy = np.array([[c.unstrained_length, c.axial_stiffness, c.linear_density] for c in true.cables]).T
    wheels = [new.radius - old.radius for new, old in zip(true.pulleys, robot.pulleys, strict=True) if new and old]
    return np.concatenate(
        [
            (true.frame_anchors - robot.frame_anchors).ravel(),
            (true.platform_anchors - robot.platform_anchors).ravel(),
            length - lengths,
            np.log(stiff / robot.axial_stiffness),
            np.log(heavy / robot.linear_density),
            [body.mass - robot.platform.mass],
            body.center_of_mass - robot.platform.center_of_mass,
            np.log(np.diag(body.inertia) / np.diag(robot.platform.inertia)),
            np.zeros(2 * m),  # load cells
            wheels or np.zeros(m),
        ]
    )


def lengths_of(case: Case) -> np.ndarray:
    return np.asarray(case.held.answer["lengths_m"])


def with_tolerances(case: Case, factor: float) -> Case:
    sizes = {name: factor * size for name, size in case.robot.tolerances.items()}
    return replace(case, robot=replace(case.robot, tolerances=sizes))


def test_true_robots_scatter_as_the_program_takes_tolerances():
    case, count = drawn(SEEDS["random, pulleys"]), 1500
    rng, lengths = np.random.default_rng(1), lengths_of(case)
    off = np.array([numbers_off(case.robot, lengths, drawn_true_robot(rng, case.robot, lengths)) for _ in range(count)])
    factor = tolerance_factor(Tolerances(**case.robot.tolerances), len(case.robot.cables))
    said, moves = factor @ factor.T, off.any(axis=0)
    assert moves.sum() == 10 * len(case.robot.cables) + 7  # all but load cells
    sigma = np.sqrt(np.diag(said))[moves]
    found = off[:, moves].T @ off[:, moves] / count / np.outer(sigma, sigma)
    wanted = said[np.ix_(moves, moves)] / np.outer(sigma, sigma)
    assert np.abs(found - wanted).max() < 5.5 * np.sqrt(2.0 / count)  # of 5000 entries, each of deviation up to that
    assert np.abs(found - np.eye(len(found))).max() > 0.4  # without the reel it is seen


@pytest.fixture(scope="module")
def moved() -> list[tuple[Case, Prediction, np.ndarray, FemRest]]:
    """Robots of each kind, their tolerances so small that all is nearly linear, by how much their numbers are really
    off, and where the FEM then has them."""
    found = []
    for kind, seed in SEEDS.items():
        case = drawn(seed)
        assert case.kind == kind
        small = with_tolerances(case, 0.03)
        prediction, lengths = predicted(small, (90,)), lengths_of(case)
        true = drawn_true_robot(case.rng, small.robot, lengths)
        truth, change, _ = fem_rest(true, case.pose.position, case.pose.rotation, prediction.sigma)
        assert change <= SURE
        found.append((small, prediction, numbers_off(case.robot, lengths, true), truth))
    return found


def test_the_fem_moves_as_predicted(moved):
    for _, prediction, off, truth in moved:
        banded = Banded.at(prediction.modes.point, AskedBand(0.9), True)
        found = mode_rates(banded.point, prediction.middle.hertz, banded.response, banded.spread)
        k = len(truth.hertz)
        rates = np.hstack([banded.response.pose[:, :3], banded.response.tension, found.own[:, :k]])
        alone = ~np.isin(found.groups[:k], [g for g in found.groups if (found.groups == g).sum() > 1])
        kept = np.concatenate([np.ones(rates.shape[1] - k, dtype=bool), alone])
        middle, sigma = prediction.middle, prediction.sigma
        distance = (truth.all - middle.all) / sigma.all
        size = np.concatenate([sigma.pose[:3], sigma.tension, sigma.hertz / middle.hertz])  # angles are no turn
        assert np.delete(distance, [3, 4, 5])[kept] == pytest.approx((off @ rates / size)[kept], abs=0.05)  # sigmas
        assert np.abs(distance).max() > 0.5


def scatter_as_said(squares: np.ndarray) -> bool:
    """Whether squares of distances in sigmas sum up to what chance allows in 99 of 100 cases."""
    least, most = chi2.ppf([0.005, 0.995], squares.size)
    return bool(least <= float(squares.sum()) <= most)


def test_truths_of_a_few_robots_scatter_as_said_and_bands_of_half_the_width_are_seen(moved):
    told = [compared(case, prediction, truth) for case, prediction, _, truth in moved]
    sigmas = np.array([[each["distance"][place] for place in each["chosen"]] for each in told])
    assert scatter_as_said(sigmas**2)
    assert not scatter_as_said((2.0 * sigmas) ** 2)
    assert ndtri([each["probability"] for each in told]) == pytest.approx(
        sigmas, abs=0.1
    )  # 4096 draws where modes meet


def test_modes_of_a_group_push_each_other_even_if_they_do_not_meet_themselves():
    # cogiro: modes 4 and 7 of nine that are linked; without their mixing mode 6 could not leave 2.91 to 2.97 Hz
    case = drawn(116)
    prediction = predicted(case, (99,))
    true = drawn_true_robot(case.rng, case.robot, lengths_of(case))
    truth, _, _ = fem_rest(true, case.pose.position, case.pose.rotation, prediction.sigma)
    told = compared(case, prediction, truth)
    assert prediction.meeting == list(range(1, 10))
    assert told["inside"]["99"][-6:] == [True] * 6


def told_lines(count: int, sigma: float = 1.0) -> list[dict]:
    """Robots whose truths are off by normal numbers of a deviation that bands take for one."""
    rng, reach = np.random.default_rng(4), {"50": 0.67449, "90": 1.64485, "99": 2.57583}
    lines = []
    for seed in range(count):
        off = sigma * rng.standard_normal(20)
        lines.append(
            {"seed": seed, "kind": FEW, "cables": 8, "warned": False, "mesh_change": 1e-3, "distance": off.tolist()}
            | {"inside": {level: (np.abs(off) < far).tolist() for level, far in reach.items()}, "chosen": [15, 3, 9]}
            | {"probability": (1.0 - chi2.sf(off[[15, 3, 9]] ** 2, 1) * 0.5).tolist()}
        )
        for i, place in enumerate(lines[-1]["chosen"]):
            above = off[place] > 0.0
            lines[-1]["probability"][i] = lines[-1]["probability"][i] if above else 1.0 - lines[-1]["probability"][i]
    return lines


def test_limits_are_exact():
    assert limits(200, 0.5) == (82, 118)
    assert limits(200, 0.99) == (194, 200)


@pytest.mark.parametrize("sigma", [0.7, 1.4])
def test_bands_too_narrow_or_too_wide_are_seen_in_every_quantity(sigma):
    assert list(faults(told_lines(200))) == []
    seen = list(faults(told_lines(200, sigma)))
    assert all(any(said.startswith(quantity) for said in seen) for quantity in QUANTITIES)


def test_true_robots_that_come_to_no_rest_count_as_outside():
    lines = [told | {"lost": "no rest"} if told["seed"] < 20 else told for told in told_lines(200)]
    assert sum("99 %" in said for said in faults(lines)) == len(QUANTITIES)


def test_the_command_tells_and_fails_on_wrong_bands(tmp_path, capsys):
    for sigma, wrong in ((1.0, 0), (1.4, 1)):
        out = tmp_path / str(sigma)
        out.mkdir()
        lines = [*told_lines(200, sigma), {"seed": 200, "kind": FEW, "cables": 3, "refused": "no modes"}]
        lines.append(told_lines(1)[0] | {"seed": 201, "warned": True})
        (out / seed_runs.FILE).write_text("".join(json.dumps(told) + "\n" for told in lines), "utf-8")
        assert running.main(["--seeds", "0:202", "--out", str(out)]) == wrong
        told = capsys.readouterr().out
        for words in ("200 robots with bands", "1 robots more", "Refused: 1"):
            assert words in told


def test_each_tolerance_is_drawn_between_a_third_and_twice_its_default():
    sizes = drawn(0).robot.tolerances
    ratio = np.array([sizes[field.name] / getattr(Tolerances(), field.name) for field in fields(Tolerances)])
    assert ((ratio >= 0.3) & (ratio <= 2.0)).all()
    assert np.ptp(ratio) > 0.5
    assert drawn(0).robot.tolerances == sizes
    assert summary([])  # of no robots, too
