"""Which rule should match peaks and modes, and what should be done with modes that nearly coincide?

Six lists, each of 16 modes, four of them within 1.2 % of their neighbour; one parameter moves every mode by its own
amount. Modes closer than 1 % at the true parameter are picked as one peak; modes are missing, peaks are spurious, one
error in twenty is five times too large. Compared: the log evidence of the shift against no shift, the error of the
parameter, its stated sd, and the time of one assignment.

    python benchmarks/peak_matching.py [campaigns]

2026-11-24, 20 campaigns, two shared cores; ln evidence of the shift against none (median error / sd, prior sigmas):

    shift of modes     one to one, as they are   detection lowered   averaged            Poisson, detection lowered
    0.4 %              10.2 (.075 / .204)        10.2 (.069 / .201)   9.0 (.183 / .243)  10.4 (.083 / .193)
    1 %                35.5 (.061 / .075)        35.5 (.060 / .075)  25.0 (.087 / .103)  33.6 (.057 / .072)
    4 %                 114 (.014 / .018)         114 (.014 / .018)    58 (.015 / .038)    97 (.014 / .018)

CPU time of one assignment, 6 lists of 30 peaks and 60 modes: Poisson .6 ms, one to one 2.4 ms, exact 8 ms.
"""

import sys
import time

import numpy as np

from cdpr_struct.association.association import Association
from cdpr_struct.association.detection import clutter
from cdpr_struct.association.doubles import detection_of_doubles
from cdpr_struct.association.modes import robot_modes
from cdpr_struct.association.peaks import PeakList, padded
from cdpr_struct.inference.evidence import fit
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseGroups

BAND = (2.0, 80.0)  # Hz
LISTS, MODES = 6, 16
SD, OWN, MERGED = 0.003, 0.001, 0.01  # of ln f: picked peak, single mode of the model, resolution of the picker
RULES, TREATMENTS = ("poisson", "one_to_one"), ("as they are", "detection lowered", "averaged")


def groups_of(ln_frequency):
    """Chains of neighbours closer than MERGED, of sorted modes."""
    return np.split(np.arange(len(ln_frequency)), np.flatnonzero(np.diff(ln_frequency) >= MERGED) + 1)


def picked(rng, ln_frequency, detection):
    """Peaks of one list [Hz]."""
    order, seen = np.argsort(ln_frequency), []
    for group in groups_of(ln_frequency[order]):
        members = order[group]
        members = members[rng.random(len(members)) < detection[members]]
        if len(members):
            seen.append(np.average(ln_frequency[members], weights=detection[members]))
    error = SD * rng.standard_normal(len(seen)) * np.where(rng.random(len(seen)) < 0.05, 5.0, 1.0)
    peaks = np.append(np.array(seen) + error, rng.uniform(*np.log(BAND), rng.poisson(1.0)))
    return np.exp(peaks[(peaks > np.log(BAND[0])) & (peaks < np.log(BAND[1]))])


def campaign(rng, size, z):
    """Nominal modes, their sensitivities and detection, and the lists measured at z."""
    ln_frequency = np.sort(rng.uniform(np.log(4.0), np.log(60.0), (LISTS, MODES)), axis=1)
    for row in ln_frequency:
        for i in rng.choice(MODES - 1, 4, replace=False):
            row[i + 1] = row[i] + rng.uniform(0.001, 0.012)
        row.sort()
    slope, detection = size * rng.uniform(-1.0, 1.0, (LISTS, MODES)), rng.uniform(0.4, 0.9, (LISTS, MODES))
    moved = ln_frequency + slope * z + OWN * rng.standard_normal((LISTS, MODES))
    seen = [picked(rng, f, p) for f, p in zip(moved, detection, strict=True)]
    lists = [PeakList(f, np.full(len(f), SD), BAND, state=k) for k, f in enumerate(seen)]
    return ln_frequency, slope, detection, padded(lists)


def averaged(ln_frequency, slope, detection):
    """One row for each chain of close modes: mean of its members by detection; own errors (LISTS, MODES, MODES)."""
    mean, own, some = np.zeros((LISTS, MODES, MODES)), np.zeros((LISTS, MODES, MODES)), np.zeros((LISTS, MODES))
    for k in range(LISTS):
        for n, group in enumerate(groups_of(ln_frequency[k])):
            mean[k, n, group] = detection[k, group] / detection[k, group].sum()
            some[k, n] = 1.0 - np.prod(1.0 - detection[k, group])
    own = OWN * mean
    return (mean @ ln_frequency[..., None])[..., 0], (mean @ slope[..., None])[..., 0], some, own


def evidence(ln_frequency, slope, detection, own, peaks, rule):
    """Fits with and without the shift."""
    r, A = np.zeros((LISTS, MODES + 1)), np.zeros((LISTS, MODES + 1, MODES))
    A[:, 1:] = own
    X = np.concatenate([np.zeros((LISTS, 1, 1)), slope[:, :, None]], axis=1)
    index = np.arange(LISTS * MODES).reshape(LISTS, MODES)
    groups = NoiseGroups(index, np.zeros(index.size, int), np.ones(index.size))
    association = Association(peaks, robot_modes(ln_frequency, detection), clutter(peaks), rule=rule)
    models = (LinearModel(r, A, x, np.ones(r.shape), groups, np.arange(1, MODES + 1)) for x in (X, 0.0 * X))
    return [fit(model, soft=association.at()) for model in models]


def compared(size, campaigns):
    """One line per rule and treatment."""
    found = {}
    for seed in range(campaigns):
        rng = np.random.default_rng(seed)
        z = rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.5)
        f, slope, p, peaks = campaign(rng, size, z)
        own = np.broadcast_to(OWN * np.eye(MODES), (LISTS, MODES, MODES))
        for treatment, case in zip(
            TREATMENTS,
            ((f, slope, p, own), (f, slope, detection_of_doubles(f, p), own), averaged(f, slope, p)),
            strict=True,
        ):
            for rule in RULES:
                found_fit, null = evidence(*case, peaks, rule)
                sd = np.sqrt(found_fit.z_covariance[0, 0])
                line = (found_fit.log_evidence, null.log_evidence, abs(found_fit.z_mean[0] - z), sd)
                found.setdefault((rule, treatment), []).append(line)
    for (rule, treatment), lines in sorted(found.items()):
        shift, null, _, _ = np.mean(lines, axis=0)
        _, _, error, sd = np.median(lines, axis=0)
        print(
            f"shift {size:5.1%}  {rule:10}  {treatment:17}  ln evidence {shift:6.1f}, of shift {shift - null:6.1f}  "
            f"median error {error:.3f} sd {sd:.3f}"
        )


def time_assignments(lists=6, peaks=30, modes=60, repeats=30):
    """CPU time of one call of `expect` [ms]."""
    rng = np.random.default_rng(0)
    f = np.sort(rng.uniform(np.log(4.0), np.log(60.0), (lists, modes)), axis=1)
    seen = [np.exp(rng.permutation(row)[:peaks] + SD * rng.standard_normal(peaks)) for row in f]
    measured = padded([PeakList(y, np.full(peaks, SD), BAND, state=k) for k, y in enumerate(seen)])
    for rule in (*RULES, "exact"):
        association = Association(measured, robot_modes(f, np.full(f.shape, 0.5)), clutter(measured), rule=rule)
        spent = []
        for _ in range(repeats):
            start = time.process_time()
            association.expect(np.zeros(f.shape), np.full(f.shape, 1e-6))
            spent.append(time.process_time() - start)
        print(f"{rule:10}  {1e3 * np.median(spent):.2f} ms")


if __name__ == "__main__":
    for shift in (0.004, 0.01, 0.04):
        compared(shift, int(sys.argv[1]) if len(sys.argv) > 1 else 20)
    time_assignments()
