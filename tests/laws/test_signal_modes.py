"""Modes from signals: standard deviations that cover the truth, peaks that are no modes, damping laws told apart."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import binom

from cdpr_struct.diagnosis.damping_law import damping_finding
from cdpr_struct.diagnosis.damping_rows import DampingRows
from cdpr_struct.measurement.decay_modes import decay_modes
from cdpr_struct.measurement.peak_kinds import COMBINATION, MODE, peak_kinds
from cdpr_struct.measurement.response_modes import response_modes
from cdpr_struct.reports.diagnose.signals import damping_sentence


def spaced(generator, count, low, high, gap):
    hertz = np.sort(generator.uniform(low, high, count))
    while np.diff(hertz).min() < gap:
        hertz = np.sort(generator.uniform(low, high, count))
    return hertz


def decay(seed, coloured):
    """20 s of five modes in three channels at 100 Hz; noise 1/30 of each channel, white or with memory."""
    generator, time = np.random.default_rng(seed), np.arange(2000) / 100.0
    hertz, ratio = spaced(generator, 5, 0.8, 12.0, 0.05), generator.uniform(0.002, 0.02, 5)
    poles = 2.0 * np.pi * hertz * (-ratio + 1j * np.sqrt(1.0 - ratio**2))
    shape = generator.normal(size=(5, 3)) * np.exp(2j * np.pi * generator.random((5, 1)))
    clean = (np.exp(np.outer(time, poles)) @ shape).real
    noise = generator.normal(size=clean.shape)
    if coloured:
        noise = lfilter([np.sqrt(1.0 - 0.81)], [1.0, -0.9], noise, axis=0)
    return decay_modes(time, clean + noise * clean.std(axis=0) / 30.0), hertz, ratio


def responses(seed, share=0.02):
    """1200 lines of six modes in three channels, one more above the band; noise a share of each line and a floor."""
    generator, lines = np.random.default_rng(seed), np.linspace(0.5, 20.0, 1200)
    hertz, ratio = spaced(generator, 6, 1.0, 18.0, 0.3), generator.uniform(0.003, 0.03, 6)
    clean = np.zeros((1200, 3), dtype=complex)
    for f, z in [*zip(hertz, ratio, strict=True), (35.0, 0.01)]:
        clean += (-(lines**2) / (f**2 - lines**2 + 2j * z * f * lines))[:, None] * generator.normal(size=3)
    size = share * (np.abs(clean) + np.median(np.abs(clean)))
    noise = size * (generator.normal(size=clean.shape) + 1j * generator.normal(size=clean.shape)) / np.sqrt(2.0)
    return response_modes(lines, clean + noise), hertz, ratio


def deviations(found, hertz, ratio):
    """Deviations of frequency and damping in their own sigma, of the modes that were found within 2 %."""
    pairs = [int(np.abs(found.hertz - f).argmin()) for f in hertz]
    near = np.abs(found.hertz[pairs] / hertz - 1.0) < 0.02
    in_hertz, in_ratio = (found.hertz[pairs] - hertz) / found.hertz_sigma[pairs], found.damping[pairs] - ratio
    return (
        in_hertz[near],
        (in_ratio / found.damping_sigma[pairs])[near],
        int((~near).sum()),
        len(found) - int(near.sum()),
    )


def covered(z, limit=1.96):
    return int((np.abs(z) < limit).sum())


@pytest.mark.parametrize("records", [4, pytest.param(8, marks=pytest.mark.slow)])
@pytest.mark.parametrize("make", [lambda s: decay(s, False), lambda s: decay(s, True), responses], ids=range(3))
def test_two_sigma_hold_the_truth_19_times_out_of_20(make, records):
    """As many of the records inside as a 95 % interval leaves with probability 1e-3; a third of sigma fails."""
    parts = [deviations(*make(seed)) for seed in range(40, 40 + records)]
    hertz, ratio = (np.concatenate([p[i] for p in parts]) for i in range(2))
    assert sum(p[2] for p in parts) == 0  # none missed
    assert sum(p[3] for p in parts) == 0  # none invented
    for z in (hertz, ratio):
        assert covered(z) >= binom.ppf(1e-3, len(z), 0.95)
        assert covered(z, 1.96 / 3.0) < binom.ppf(1e-3, len(z), 0.95)
        assert 0.6 < np.sqrt((z**2).mean()) < 1.5  # neither far too narrow nor far too wide


def test_combination_tones_are_no_modes():
    """A quadratic sensor makes tones at sums and differences; a mode of its own at another place stays a mode."""
    time = np.arange(3000) / 100.0
    one, two, three = (np.exp(-0.05 * time) * np.cos(2.0 * np.pi * f * time) for f in (1.31, 2.2, 5.9))
    linear = np.stack([one + 0.5 * two, 0.7 * two - 0.4 * one], axis=1) + 0.01 * three[:, None] * [1.0, -1.0]
    noise = 1e-3 * np.random.default_rng(5).normal(size=linear.shape)
    found = decay_modes(time, linear + 0.08 * linear**2 + noise)
    kinds = dict(zip(found.hertz.round(2).tolist(), peak_kinds(found), strict=True))
    assert [kinds[f] for f in (1.31, 2.2, 5.9)] == [MODE] * 3
    assert kinds[2.62] == COMBINATION
    assert kinds[3.51] == COMBINATION
    plain = decay_modes(time, linear + noise)
    assert peak_kinds(plain) == [MODE] * 3


def test_noise_alone_has_no_modes():
    time = np.arange(2000) / 100.0
    assert len(decay_modes(time, np.random.default_rng(1).normal(size=(2000, 3)))) == 0
    generator = np.random.default_rng(2)
    noise = generator.normal(size=(600, 2)) + 1j * generator.normal(size=(600, 2))
    assert len(response_modes(np.linspace(1.0, 20.0, 600), noise)) == 0


def rows(law, size, seed=3):
    """Six modes, three amplitudes each, damped by one law beside the entered one; 3 % of noise."""
    generator = np.random.default_rng(seed)
    hertz, amplitude = np.repeat([1.0, 1.7, 2.9, 4.1, 6.3, 8.8], 3), np.tile([4e-3, 2e-3, 1e-3], 6)
    share = np.repeat(generator.uniform(0.5, 1.0, 6), 3)
    signature = {
        "entered": 2e-3 / hertz, "material": np.pi * hertz * share, "structural": 0.5 * share,
        "friction": 1e-3 / (hertz**2 * amplitude),
    }  # fmt: skip
    ratio = signature["entered"] + size * signature[law]
    ratio = ratio * (1.0 + 0.03 * generator.normal(size=18))
    return DampingRows(
        ("a",) * 18, np.repeat(np.arange(6), 3), hertz, ratio, 0.03 * ratio, amplitude, **signature
    )  # fmt: skip


@pytest.mark.parametrize(
    ("law", "size", "cause"),
    [
        ("entered", 3.0, "viscous_damping"),
        ("material", 8e-4, "viscous_damping"),
        ("structural", 0.02, "hysteretic_damping"),
        ("friction", 0.02, "coulomb_damping"),
    ],
)
def test_each_law_is_named_and_its_size_found(law, size, cause):
    found = damping_finding(rows(law, size), 0.3)
    assert (found.status, found.causes) == ("named", (cause,))
    best = next(f for f in found.fits if f.causes == (cause,))
    _, low, high = next(iter(best.sizes.values()))
    shift = 1.0 if law == "entered" else 0.0
    assert low < size + shift < high


def test_the_entered_damping_is_adequate():
    assert damping_finding(rows("entered", 0.0), 0.3).status == "adequate"


def test_scatter_beyond_the_sigmas_is_no_law():
    """Ratios up and down by a factor of three: nothing beats the entered law, so that it is not declared wrong."""
    whole = rows("entered", 0.0)
    wild = np.exp(1.1 * np.random.default_rng(4).choice([-1.0, 1.0], size=18))
    found = damping_finding(replace(whole, ratio=whole.ratio * wild, sigma=0.03 * whole.ratio), 0.3)
    assert found.fits[0].p_adequate < 1e-3
    assert (found.status, found.causes) == ("not testable", ())
    assert "scatter" in found.reason
    assert "No statement" in damping_sentence(found)


def test_one_mode_does_not_tell_material_from_structure():
    whole = rows("structural", 0.02)
    first = np.arange(3)
    one = DampingRows(whole.case[:3], *(getattr(whole, n)[first] for n in DampingRows.__slots__ if n != "case"))
    found = damping_finding(one, 0.3)
    assert found.status == "class"
    assert {"viscous_damping", "hysteretic_damping"} <= set(found.causes)


def test_a_peak_in_much_noise_is_not_doubled():
    """What a rough fit leaves beside a peak looked like further modes within its width."""
    for seed in (9105, 9107):
        assert deviations(*responses(seed, 0.1))[2:] == (0, 0)


def test_narrow_peaks_of_a_wide_band_are_found():
    """Nine modes, each narrower than a line, in 1 to 40 Hz: no order that noise allows resolves them all at once."""
    generator, lines = np.random.default_rng(3), np.linspace(1.0, 40.0, 1951)
    hertz = spaced(generator, 9, 1.5, 9.0, 0.25)
    clean = np.zeros((len(lines), 4), dtype=complex)
    for f in hertz:
        clean += (-(lines**2) / (f**2 - lines**2 + 2e-3j * f * lines))[:, None] * generator.normal(size=4)
    size = 0.002 * np.abs(clean).max()
    noise = size * (generator.normal(size=clean.shape) + 1j * generator.normal(size=clean.shape)) / np.sqrt(2.0)
    found = response_modes(lines, clean + noise)
    z = deviations(found, hertz, np.full(9, 1e-3))
    assert z[2:] == (0, 0)
    assert np.abs(z[0]).max() < 3.5
