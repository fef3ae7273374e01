"""A predicted vibration as text for a terminal."""

import math
from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import paragraphs, place, plain_table


def transient_text(result: Mapping[str, Any]) -> str:
    """Largest motion and dominant frequency of every port, then the summary."""
    title = (
        f"{result['robot']} at {place(result['pose'][:3])}, cables {result['model']}, damping {result['damping']}: "
        f"{result['duration_s']:g} s with the modes up to {result['highest_hz']:g} Hz"
    )
    columns = ["", "largest displacement", "largest acceleration", "dominant [Hz]"]
    head = f"{title}\n{result['damping_note']}"
    return paragraphs(head, plain_table("Vibration", columns, port_rows(result)), transient_summary(result))


def port_rows(result: Mapping[str, Any]) -> list[list[str]]:
    """Name, largest displacement and acceleration with units, dominant frequency of every port."""
    rows = []
    for port in result["ports"]:
        turns = "largest_displacement_rad" in port
        unit, factor = ("mrad", 1e3) if turns else ("mm", 1e3)
        length = "rad" if turns else "m"
        moved, rate = port[f"largest_displacement_{length}"], port[f"largest_acceleration_{length}_s2"]
        sizes = [f"{factor * moved:.4g} {unit}", f"{rate:.4g} {length}/s²", f"{port['dominant_hz']:.4f}"]
        rows.append([port["name"], *(["0", "0", "-"] if math.isnan(port["dominant_hz"]) else sizes)])
    return rows


def transient_summary(result: Mapping[str, Any]) -> str:
    """Dominant frequency, the mode next to it, and what the superposed modes can hold of the excitation."""
    modes, dominant = result["natural_frequencies_hz"], result["dominant_hz"]
    if math.isnan(dominant):
        return "The platform does not vibrate."
    index = min(range(len(modes)), key=lambda i: abs(modes[i] - dominant))
    return (
        f"The platform vibrates mainly at {dominant:.3f} Hz, next to mode {index + 1} ({modes[index]:.4f} Hz, "
        f"{result['kinds'][index]}). The {len(modes)} modes hold {100.0 * result['energy_share']:.3f} % of the "
        "energy of the excitation."
    )
