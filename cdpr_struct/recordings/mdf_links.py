"""Lists of blocks in an MDF file: asammdf follows them without end where a damaged one leads back to an earlier one."""

import struct
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

from cdpr_struct.errors import InputError

_FIRST = 64  # address of the block from which all others are reached
_ANY = b""  # a block of any kind may be there
_LED_TO: Mapping[bytes, Sequence[bytes]] = {  # kinds of the blocks that the first links of a block lead to
    b"##HD": (b"##DG", b"##FH", b"##CH", b"##AT", b"##EV"), b"##DG": (b"##DG", b"##CG", _ANY),
    b"##CG": (b"##CG", b"##CN"), b"##CN": (b"##CN", _ANY), b"##CA": (_ANY,), b"##DL": (b"##DL",), b"##LD": (b"##LD",),
    b"##HL": (_ANY,), b"##FH": (b"##FH",), b"##AT": (b"##AT",), b"##EV": (b"##EV",), b"##CH": (b"##CH", b"##CH"),
    b"HD": (b"DG",), b"DG": (b"DG", b"CG"), b"CG": (b"CG", b"CN"), b"CN": (b"CN",),
}  # fmt: skip
_VERSION, _ORDER = slice(8, 9), slice(24, 26)  # of the first bytes
_FOUR = b"4"


def check_links(path: Path, form: str) -> None:
    """Refuse a file whose lists lead back to a block that they have passed, or to one of another kind.

    Raises
    ------
    InputError : there is such a block.
    """
    with path.open("rb") as file:
        head = file.read(_FIRST)
        order, kind, size, before = ("<", "Q", 4, 24) if head[_VERSION] == _FOUR else ("<", "I", 2, 4)
        order = ">" if kind == "I" and any(head[_ORDER]) else order
        passed: set[int] = set()
        waiting = [(_FIRST, b"##HD" if size == len(b"##HD") else b"HD")]
        while waiting:
            address, expected = waiting.pop()
            file.seek(address)
            found = file.read(before)[:size]
            if address in passed or (expected and found != expected):
                given = f"{form} whose lists of blocks are damaged at byte {address}"
                raise InputError(str(path), "", given, "a whole file of that kind")
            if found in _LED_TO:
                passed.add(address)
                waiting += _links(file, order + kind, _LED_TO[found])


def _links(file: BinaryIO, form: str, kinds: Sequence[bytes]) -> Iterator[tuple[int, bytes]]:
    """Addresses that a block leads to, and the kinds of the blocks that must be there; the file is at its links."""
    size = struct.calcsize(form)
    read = file.read(size * len(kinds))
    for i, kind in enumerate(kinds):
        (address,) = struct.unpack(form, read[i * size : (i + 1) * size].rjust(size, b"\0"))
        if 0 < address < 1 << 62:
            yield address, kind
