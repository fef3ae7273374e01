"""Ambient records of a campaign: checked, and analysed in their band for modes."""

from dataclasses import dataclass, replace

import numpy as np
from joblib import Parallel, delayed

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.ambient_band import PERIODS, Spectrum, band_of, spectrum_of, thinned
from cdpr_struct.measurement.ambient_checks import check_channels
from cdpr_struct.measurement.ambient_choice import AmbientChoice
from cdpr_struct.measurement.ambient_modes import BLOCKS, AmbientModes, Diagram, ambient_modes, block_rows
from cdpr_struct.measurement.campaign import Sigmas
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.measurement.subspace_poles import require_pyoma


@dataclass(frozen=True, slots=True, eq=False)
class AmbientRecord:
    """Modes of one ambient record.

    channels : c names;  duration [s], rate [Hz] of the record;  band : that was analysed [Hz]
    analysed_rate : of the thinned record [Hz]
    sigma : (k,) of the frequencies as they join the campaign [Hz]: with what the campaign file adds
    """

    case: str
    file: str
    channels: tuple[str, ...]
    duration: float
    rate: float
    band: tuple[float, float]
    analysed_rate: float
    choice: AmbientChoice
    modes: AmbientModes
    sigma: np.ndarray
    diagram: Diagram
    spectrum: Spectrum


def identified_records(records: list[tuple[SignalRecord, Sigmas, AmbientChoice]]) -> tuple[AmbientRecord, ...]:
    """Modes of all records, which are checked before the first is analysed.

    Raises
    ------
    InputError : pyOMA-2 is not installed, or a record that cannot be used.
    """
    if not records:
        return ()
    require_pyoma()
    for record, _, _ in records:
        check_channels(record)
    cores = -1 if len(records) > 1 else 1
    return tuple(Parallel(n_jobs=cores)(delayed(identified)(*one) for one in records))


def identified(record: SignalRecord, sigmas: Sigmas, choice: AmbientChoice) -> AmbientRecord:
    """Modes of one record.

    Raises
    ------
    InputError : too short or too slowly sampled for its band, or no stable pole near a frequency that was asked for.
    """
    count = len(record.axis)
    step = float(record.axis[-1] - record.axis[0]) / (count - 1)
    try:
        _check_length(record, step)
        spectrum = spectrum_of(record.signal, step)
        band = band_of(spectrum, choice, step, count, _samples(record.signal.shape[1]))
        signal, thin = thinned(record.signal, step, band)
        _check_samples(signal, thin, band)
        modes, diagram = ambient_modes(signal, thin, replace(choice, band=band))
    except InputError as error:
        where = f"case {record.case}, {error.source}"
        raise InputError(record.file, where, error.value, error.expected) from error
    own = modes.hertz_sigma
    sigma = own if sigmas.frequency_hz is None else np.hypot(own, sigmas.frequency_hz)
    return AmbientRecord(
        record.case, record.file, record.channels, step * count, 1.0 / step, band, 1.0 / thin, choice, modes, sigma,
        diagram, spectrum,
    )  # fmt: skip


def _check_length(record: SignalRecord, step: float) -> None:
    """Refuse a record that is too short for any band."""
    needed = _samples(record.signal.shape[1])
    if len(record.axis) < needed:
        raise InputError("duration", "", f"{step * len(record.axis):.4g} s", _longer(needed * step))


def _check_samples(signal: np.ndarray, step: float, band: tuple[float, float]) -> None:
    """Refuse a record that is too short for the band."""
    needed = _samples(signal.shape[1])
    if len(signal) < needed:
        raise InputError("duration", "", f"{step * len(signal):.4g} s", _longer(needed * step, band))


def _samples(channels: int) -> int:
    """Fewest samples: each block holds all lags of the covariances."""
    return 2 * block_rows(channels) * BLOCKS


def _longer(seconds: float, band: tuple[float, float] | None = None) -> str:
    of_band = "" if band is None else f" for a band up to {band[1]:.4g} Hz"
    return f"{seconds:.4g} s or more{of_band}, better 10 minutes: {PERIODS:g} periods of a mode at the very least"
