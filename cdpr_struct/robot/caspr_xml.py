"""Reading CASPR's XML with messages that name the file, the element and the text found there."""

from xml.etree import ElementTree

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot_file import LARGEST


def parse(text: str, source: str) -> ElementTree.Element:
    """Root element of an XML text.

    Raises
    ------
    InputError : not well-formed XML, or one that defines entities of its own.
    """
    if "<!ENTITY" in text:
        raise InputError(source, "", "<!ENTITY", "an XML file without entity definitions")
    try:
        return ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InputError(source, "", str(error), "a well-formed XML file") from error


def child(parent: ElementTree.Element, name: str, source: str) -> ElementTree.Element:
    """The child element of a name."""
    found = parent.find(name)
    if found is None:
        raise InputError(source, f"{parent.tag}.{name}", "nothing", "this element is required")
    return found


def attribute(element: ElementTree.Element, name: str, source: str, known: tuple[str, ...]) -> str:
    """An attribute that is one of a few words."""
    text = element.get(name)
    if text not in known:
        raise InputError(source, f"{element.tag}.{name}", text or "nothing", f"one of: {', '.join(known)}")
    return text


def value(parent: ElementTree.Element, name: str, source: str) -> float:
    """The finite number that a child element holds."""
    return float(numbers(parent, name, source, 1)[0])


def numbers(parent: ElementTree.Element, name: str, source: str, count: int) -> np.ndarray:
    """The finite numbers (count,) that a child element holds."""
    text = child(parent, name, source).text or ""
    try:
        found = np.array([float(part) for part in text.split()])
    except ValueError as error:
        raise InputError(source, f"{parent.tag}.{name}", text.strip(), f"{count} finite number(s)") from error
    if found.shape != (count,) or not (np.abs(found) <= LARGEST).all():
        expected = f"{count} finite number(s), of at most {LARGEST:g}"
        raise InputError(source, f"{parent.tag}.{name}", text.strip(), expected)
    return found
