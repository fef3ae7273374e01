"""A predicted vibration as text for a terminal."""

import math
from collections.abc import Mapping
from typing import Any

from cdpr_struct.reports.text import paragraphs, place, plain_table

PORT_COLUMNS = ["", "largest displacement", "dominant [Hz]", "largest acceleration", "dominant [Hz]"]


def transient_text(result: Mapping[str, Any]) -> str:
    """Largest motion and dominant frequency of every port, then the summary."""
    title = (
        f"{result['robot']} at {place(result['pose'][:3])}, cables {result['model']}, damping {result['damping']}: "
        f"{result['duration_s']:g} s with the modes up to {result['highest_hz']:g} Hz"
    )
    head = f"{title}\n{result['damping_note']}"
    return paragraphs(head, plain_table("Vibration", PORT_COLUMNS, port_rows(result)), transient_summary(result))


def port_rows(result: Mapping[str, Any]) -> list[list[str]]:
    """Name, then largest displacement and acceleration with units and the dominant frequency of each, of every port."""
    rows = []
    for port in result["ports"]:
        turns = "largest_displacement_rad" in port
        unit, factor = ("mrad", 1e3) if turns else ("mm", 1e3)
        length = "rad" if turns else "m"
        moved, rate = port[f"largest_displacement_{length}"], port[f"largest_acceleration_{length}_s2"]
        slow, fast = f"{port['dominant_displacement_hz']:.4f}", f"{port['dominant_hz']:.4f}"
        sizes = [f"{factor * moved:.4g} {unit}", slow, f"{rate:.4g} {length}/s²", fast]
        rows.append([port["name"], *(["0", "-", "0", "-"] if math.isnan(port["dominant_hz"]) else sizes)])
    return rows


def transient_summary(result: Mapping[str, Any]) -> str:
    """Dominant frequency, the mode next to it, and what the superposed modes can hold of the excitation."""
    modes = result["natural_frequencies_hz"]
    if math.isnan(result["dominant_hz"]):
        return "The platform does not vibrate."
    fast, slow = (_next_to_mode(result, key) for key in ("dominant_hz", "dominant_displacement_hz"))
    return (
        f"The platform's acceleration is mainly at {fast}, its displacement at {slow}. The {len(modes)} modes hold "
        f"{100.0 * result['energy_share']:.3f} % of the energy of the excitation."
    )


def _next_to_mode(result: Mapping[str, Any], key: str) -> str:
    """A dominant frequency, and the mode next to it."""
    modes, dominant = result["natural_frequencies_hz"], result[key]
    index = min(range(len(modes)), key=lambda i: abs(modes[i] - dominant))
    return f"{dominant:.3f} Hz (mode {index + 1}: {modes[index]:.4f} Hz, {result['kinds'][index]})"
