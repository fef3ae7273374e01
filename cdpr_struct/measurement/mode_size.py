"""How much of a mode is the platform's own, as a frequency response says it by its size, wherever the model has it.

The residue of an accelerance holds the modal constant, the product of the mode's motion at sensor and force over its
modal mass. Times the platform's mass, at the same place and along the same axis, that is the share of the mode's
kinetic energy that lies in this motion of the platform (docs/diagnosis.md, Recordings become frequencies).
"""

import numpy as np

from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.signal_records import MOTION, SignalRecord

_MOST_OFF = 3.0  # factor between the largest measured and modelled sizes beyond which the unit must be wrong


def direction(name: str) -> np.ndarray:
    """(6,) unit platform motion that a channel's name means: x .. rz, fx .. mz; zeros for any other."""
    sign, text = (-1.0 if name.strip().startswith("-") else 1.0), name.strip().lower().removeprefix("-")
    text = "r" + text[1:] if text.startswith("m") else text.removeprefix("f")
    found = np.zeros(6)
    if text in MOTION:
        found[MOTION.index(text)] = sign
    return found


def ways(record: SignalRecord) -> np.ndarray:
    """(c, 2, 6) unit motions along which an FRF's channels respond and are excited."""
    return np.array([[direction(part) for part in name.split("/", 1)] for name in record.channels])


def channel_shapes(platform: np.ndarray, record: SignalRecord) -> np.ndarray:
    """(k, c) modal constants in an FRF's channels of modes of unit modal mass whose platforms move by (k, 6)."""
    respond, excite = ways(record).transpose(1, 0, 2)
    return np.asarray((platform @ respond.T) * (platform @ excite.T))


def modal_constants(modes: Modes) -> np.ndarray:
    """(k, c) complex modal constants of an FRF's modes, per channel [1/kg, 1/(kg m), 1/(kg m^2)]."""
    pole = modes.poles
    found: np.ndarray = modes.shape * (2j * pole.imag / pole**2)[:, None]
    return found


def translation_share(modes: Modes, record: SignalRecord, mass: float) -> np.ndarray:
    """(k,) least share of the kinetic energy in the platform's translation; zero where no channel shows any.

    Axes that were watched but not shaken follow from those that were shaken: a mode's constants are a product.
    """
    if record.kind != "frf":
        return np.zeros(len(modes))
    product = np.zeros((len(modes), 3, 3), dtype=complex)
    for (respond, excite), constant in zip(ways(record), modal_constants(modes).T, strict=True):
        if np.abs(respond[:3]).any() and np.abs(excite[:3]).any():
            product += constant[:, None, None] * np.outer(respond[:3], excite[:3])
    own = np.abs(np.einsum("kii->ki", product))
    rows = np.arange(len(modes))
    best = own.argmax(axis=1)
    across = np.abs(product[rows, :, best]) ** 2 / np.maximum(own[rows, best], 1e-300)[:, None]
    share: np.ndarray = mass * np.where(own > 0.0, own, across).sum(axis=1)
    return np.where(own.max(axis=1) > 0.0, share, 0.0)


def log_sizes(modes: Modes, shapes: np.ndarray) -> np.ndarray:
    """(k, l) ln of measured over modelled size of modes and the model's shapes (l, c) in an FRF's channels.

    Zeros where the largest have nothing to do with the model's, as with a wrong unit.
    """
    size, model = np.linalg.norm(modal_constants(modes), axis=1), np.linalg.norm(shapes, axis=1)
    off = np.log(np.maximum(size, 1e-300)[:, None] / np.maximum(model, 1e-300)[None])
    strongest = np.sort(size)[-3:].mean() / max(np.sort(model)[-3:].mean(), 1e-300) if len(size) else 1.0
    return off if 1.0 / _MOST_OFF < strongest < _MOST_OFF else np.zeros_like(off)
