"""Changes that keep most of a text file well-formed, so that a run gets past the parser."""

import random
import re

from tests.fuzz.seeds import WORDS

_TOKEN = re.compile(rb"[-+]?[0-9][0-9.eE+-]*|[A-Za-z_][A-Za-z0-9_]*")
_LONG = 40_000  # bytes of a word that is repeated


def changed(data: bytes, rng: random.Random) -> bytes:
    """The input with a few tokens or lines exchanged, repeated or left out."""
    for _ in range(rng.choice((1, 1, 2, 4))):
        data = rng.choice((_token, _token, _token, _line))(data, rng)
    return data


def _token(data: bytes, rng: random.Random) -> bytes:
    """Another word, or number, in place of one."""
    found = list(_TOKEN.finditer(data))
    if not found:
        return data + rng.choice(WORDS)
    place = rng.choice(found)
    other = rng.choice(found)[0] if rng.random() < 0.3 else rng.choice(WORDS)
    word = rng.choice((other, place[0] + other, b"-" + place[0], place[0] * 2))
    if rng.random() < 0.6 and place[0].isdigit():
        word = b"%d" % max(0, int(place[0][:9]) + rng.randint(-3, 3))  # still what is asked for, more often than not
    if rng.random() < 0.01:
        word = word * (_LONG // max(1, len(word)))
    return data[: place.start()] + word + data[place.end() :]


def _line(data: bytes, rng: random.Random) -> bytes:
    """A line left out, repeated or moved."""
    lines = data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    line = lines[i]
    if rng.random() < 0.6:
        del lines[i]
    if rng.random() < 0.6:
        lines.insert(j, line)
    return b"\n".join(lines)
