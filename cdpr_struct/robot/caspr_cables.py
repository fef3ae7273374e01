"""Cables of a CASPR model: where they are attached, how stiff they are, and how hard they may pull."""

from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.caspr_xml import attribute, numbers, value

_PULLEY = "base_rotating_pulley"


@dataclass(frozen=True, slots=True, eq=False)
class CableEnds:
    """A cable as the model describes it.

    frame, platform      : (3,) where it is attached, world and platform frame [m]; with a pulley, where it enters that
    pulley               : of the frame end, None for a fixed point
    stiffness            : EA [N], None if the model has none
    force_min, force_max : limits of its force [N], None for no upper limit
    """

    frame: np.ndarray
    platform: np.ndarray
    stiffness: float | None
    force_min: float
    force_max: float | None
    pulley: Pulley | None = None

    def limit_lines(self) -> list[str]:
        """Lines of a robot file that say its force limits."""
        lines = [f"force_min = {self.force_min!r}"] if self.force_min else []
        return lines if self.force_max is None else [*lines, f"force_max = {self.force_max!r}"]


def cable_ends(
    root: ElementTree.Element, source: str, cable_set: str | None, center: np.ndarray, warnings: list[str]
) -> list[CableEnds]:
    """The cables of a cable set (None: the file's default), platform ends from the joint on.

    center : (3,) centre of mass from the joint on [m];  warnings : what to check is added here

    Raises
    ------
    InputError : no such set, or a cable that is not one straight segment from the frame to the platform.
    """
    sets = root.findall("cable_set")
    known = [s.get("id") or "" for s in sets]
    wanted = _chosen(root, known, source, cable_set)
    elements = list(sets[known.index(wanted)])
    if not elements:
        raise InputError(source, f"cable_set {wanted}", "no cables", "at least one cable")
    if len(sets) > 1:
        warnings.append(f"cable set {wanted!r} of {', '.join(known)}. Give --cable-set for another.")
    return [_one_cable(element, source, f"cable {i}", center) for i, element in enumerate(elements, start=1)]


def _chosen(root: ElementTree.Element, known: list[str], source: str, cable_set: str | None) -> str:
    """Name of the cable set: the user's, the file's default, or the only one."""
    if len(set(known)) < len(known):
        raise InputError(source, "cable_set.id", ", ".join(known), "a name of its own for each cable set")
    default = root.get("default_cable_set") or (known[0] if len(known) == 1 else "")
    wanted = cable_set or default
    if wanted not in known:
        place = "--cable-set" if cable_set or len(known) > 1 else source
        listed = ", ".join(known) or "it has none"
        raise InputError(place, "", wanted or "nothing", f"a cable set of the file: {listed}")
    return wanted


def _one_cable(element: ElementTree.Element, source: str, label: str, center: np.ndarray) -> CableEnds:
    """A cable; points on link 0 are in the world, whatever `attachment_reference` says of those on the platform."""
    reference = attribute(element, "attachment_reference", source, ("joint", "com"))
    ends: dict[int, np.ndarray] = {}
    pulley = None
    attachments = element.findall("attachments/*")
    for number, attachment in enumerate(attachments):
        if attachment.tag == _PULLEY and number == 0:
            ends[0], pulley = numbers(attachment, "fixed_location", source, 3), _pulley(attachment, source, label)
        elif attachment.tag == "attachment":
            ends[int(value(attachment, "link", source))] = numbers(attachment, "location", source, 3)
        else:
            expected = f"a plain attachment point, or first a {_PULLEY}"
            raise InputError(source, label, attachment.tag, expected)
    if len(attachments) != 2 or set(ends) != {0, 1}:
        raise InputError(source, label, f"attachments on links {sorted(ends)}", "one on link 0 and one on link 1")
    platform = ends[1] + (center if reference == "com" else 0.0)
    stiffness = _property(element, "K", source)
    if stiffness is not None and not stiffness > 0.0:
        raise InputError(source, f"{label}.K", stiffness, "a stiffness EA in N above zero")
    return CableEnds(ends[0], platform, stiffness, *_force_limits(element, source, label), pulley)


def _pulley(element: ElementTree.Element, source: str, label: str) -> Pulley:
    """CASPR's pulley swivels about the direction in which the cable enters it, as ours does."""
    radius, axis = value(element, "pulley_radius", source), numbers(element, "cable_entry_vector", source, 3)
    if not radius > 0.0:
        raise InputError(source, f"{label}.pulley_radius", radius, "a radius in m above zero")
    if not axis.any():
        raise InputError(source, f"{label}.cable_entry_vector", "0 0 0", "the direction in which the cable enters")
    return Pulley(radius, axis)


def _force_limits(element: ElementTree.Element, source: str, label: str) -> tuple[float, float | None]:
    """Smallest and largest force of a cable [N]: zero and none where the file has none."""
    low, high = _property(element, "force_min", source) or 0.0, _property(element, "force_max", source)
    if low < 0.0:
        raise InputError(source, f"{label}.force_min", low, "a force in N, zero or more")
    if high is not None and not high > low:
        raise InputError(source, f"{label}.force_max", high, f"a force in N above force_min, {low:g} N")
    return low, high


def _property(element: ElementTree.Element, name: str, source: str) -> float | None:
    """A number among the properties of a cable, None if it is not there."""
    properties = element.find("properties")
    return None if properties is None or properties.find(name) is None else value(properties, name, source)
