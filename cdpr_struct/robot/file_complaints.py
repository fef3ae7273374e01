"""What is wrong with a file, in one sentence: file, field, value and what would be right."""

from typing import get_args

from pydantic import BaseModel, ValidationError

from cdpr_struct.errors import InputError, known_names


def input_error(source: str, error: ValidationError, model: type[BaseModel] | None = None) -> InputError:
    """The first complaint of pydantic as one sentence with file, field, value and what would be right.

    model : of the whole file, to say which keys are known where one is not
    """
    found = error.errors()
    misspelt = [e for e in found if e["type"] == "extra_forbidden"] if found[0]["type"] == "missing" else []
    first = [*misspelt, *found][0]
    field = "".join(f"[{p + 1}]" if isinstance(p, int) else f".{p}" for p in first["loc"]).lstrip(".")
    value = "nothing" if first["type"] == "missing" else first["input"]
    words = _EXPECTED.get(first["type"])
    expected = first["msg"].lower() if words is None else words.format(**first.get("ctx", {}))
    if first["type"] in ("list_type", "too_short", "too_long") and _INERTIAS & set(first["loc"]):
        expected += "; an inertia has three rows: [[Ixx, 0, 0], [0, Iyy, 0], [0, 0, Izz]]"
    if first["type"] == "extra_forbidden" and model is not None:
        known = known_keys(model, first["loc"][:-1])
        expected += "; " + known_names(str(first["loc"][-1]), known)
    return InputError(source, field, value, expected)


def known_keys(model: type[BaseModel], place: tuple[int | str, ...]) -> list[str]:
    """Keys of the table at a place of a file: names and numbers of entries from the top."""
    for step in (step for step in place if isinstance(step, str) and step in model.model_fields):
        inner = [model.model_fields[step].annotation]
        while inner and not (isinstance(inner[0], type) and issubclass(inner[0], BaseModel)):
            inner = [*get_args(inner[0]), *inner[1:]]
        if inner and isinstance(inner[0], type):
            model = inner[0]
    return sorted(model.model_fields)


_INERTIAS = {"inertia", "platform_inertia"}
_EXPECTED = {
    "extra_forbidden": "no such key is known here",
    "missing": "this key is required",
    "finite_number": "give a finite number",
    "float_type": "give a number, without quotes",
    "model_type": "give a table with keys of its own",
    "dict_type": "give a table with keys of its own",
    "string_type": "give a text in quotes",
    "list_type": "give a list in square brackets",
    "too_short": "give at least {min_length} entries, not {actual_length}",
    "too_long": "give at most {max_length} entries, not {actual_length}",
    "greater_than": "give a number above {gt:g}",
    "greater_than_equal": "give a number not below {ge:g}",
    "less_than": "give a number below {lt:g}",
    "less_than_equal": "give a number not above {le:g}",
}
