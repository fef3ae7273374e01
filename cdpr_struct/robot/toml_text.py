"""Text of a TOML file as a table, or what is wrong with it in one sentence."""

import re
import tomllib
from typing import Any

from cdpr_struct.errors import InputError

_DEEPEST = 64  # keys in a row, a.b.c; the standard library's parser takes minutes for thousands
_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_TOO_DEEP = re.compile(rf"""(?<![\w."'-])(?:{_PART}){{{_DEEPEST}}}""")


def toml_table(text: str, source: str) -> dict[str, Any]:
    """The table that the text of a file holds; complaints call the file `source`.

    Raises
    ------
    InputError : no TOML, or lists, tables or numbers that no file of this program needs.
    """
    if found := _TOO_DEEP.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(source, f"line {line}", found[0], f"tables in tables at most {_DEEPEST} deep")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _no_toml(source, text, error) from error
    except RecursionError as error:
        raise InputError(source, "", "lists or tables within each other, too deep to read", "a flat file") from error
    except ValueError as error:  # Python converts no integer of more than some thousand digits
        raise InputError(source, "", "a number with thousands of digits", "numbers of at most 17 digits") from error


def _no_toml(source: str, text: str, error: tomllib.TOMLDecodeError) -> InputError:
    """What is wrong with a file that is no TOML, and the line where it ends to be."""
    where = re.search(r" \(at line (\d+), column \d+\)", str(error))
    reason = str(error) if where is None else str(error)[: where.start()]
    lines = text.splitlines()
    number = len(lines) if where is None else min(int(where[1]), len(lines))
    line = lines[number - 1].strip() if lines else ""
    expected = f"a TOML file: decimals with a point, text in quotes, each key and table given once ({reason})"
    return InputError(source, f"line {number}", line, expected)
