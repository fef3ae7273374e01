"""CSV tables as Parquet: columns with their types, for tables too long to be read as text."""

import io
from collections.abc import Iterable, Mapping

import pandas as pd


def parquet_tables(files: Mapping[str, str | bytes | Iterable[bytes]]) -> dict[str, bytes]:
    """Each CSV file of a result once more under its own name; the same numbers, empty cells as missing."""
    return {
        f"{name.removesuffix('.csv')}.parquet": _parquet(content)
        for name, content in files.items()
        if name.endswith(".csv")
    }


def _parquet(content: str | bytes | Iterable[bytes]) -> bytes:
    if isinstance(content, str):
        raw = content.encode("utf-8")
    else:
        raw = content if isinstance(content, bytes) else b"".join(content)
    table = pd.read_csv(io.BytesIO(raw))
    written = io.BytesIO()
    table.to_parquet(written, index=False)
    return written.getvalue()
