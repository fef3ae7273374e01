"""Modes identified in the signals of a campaign, and which of them join it as robot frequencies."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.measurement.amplitude_windows import AmplitudeWindows
from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.measurement.state_modes import StateModes


@dataclass(frozen=True, slots=True, eq=False)
class Identified:
    """One record with its k identified modes.

    sigma   : (k,) of the frequencies as they join the campaign [Hz]: of the fit, times the scatter between windows
    kinds   : (k,) "mode" or "combination tone"
    partner : (k,) number of the model's mode, -1 without one
    used    : (k,) bool, joins the campaign as a robot frequency
    reason  : (k,) why not, "" if used;  note : why the record as a whole is not used, or ""
    state   : the model at that state, None if it could not be computed (see `note`)
    """

    record: SignalRecord
    modes: Modes
    windows: AmplitudeWindows | None
    sigma: np.ndarray
    kinds: tuple[str, ...]
    partner: np.ndarray
    used: np.ndarray
    reason: tuple[str, ...]
    note: str
    state: StateModes | None


def lost_notes(records: Iterable[SignalRecord]) -> tuple[str, ...]:
    """Sentences on records that lack samples or lines."""
    rows = [(one, len(one.axis) + (one.missing if one.kind == "frf" else 0)) for one in records if one.missing]
    return tuple(
        f"{one.file}, case {one.case}: {one.missing} of {total} {'lines' if one.kind == 'frf' else 'samples'} are "
        "missing; they have no weight."
        for one, total in rows
    )
