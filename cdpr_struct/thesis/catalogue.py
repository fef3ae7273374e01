"""Every thesis item that can be recomputed, by name."""

from collections.abc import Callable

from cdpr_struct.thesis.cable_tables import table_2_2, table_2_3, table_2_4
from cdpr_struct.thesis.reproduction import Reproduction

ITEMS: dict[str, Callable[[], Reproduction]] = {
    "table-2.2": table_2_2,
    "table-2.3": table_2_3,
    "table-2.4": table_2_4,
}
