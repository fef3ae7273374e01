"""Which extensions of a robot file act: see `reports.extension_notes`."""

from cdpr_struct.reports.extension_notes import with_extensions

__all__ = ["with_extensions"]
