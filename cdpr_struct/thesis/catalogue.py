"""Every thesis item that can be recomputed, by name, in the order of the thesis."""

from collections.abc import Callable

from cdpr_struct.thesis.cable_profiles import fig_2_4
from cdpr_struct.thesis.cable_tables import table_2_2, table_2_3, table_2_4
from cdpr_struct.thesis.load_thresholds import fig_4_4
from cdpr_struct.thesis.pose_errors import fig_3_4, fig_3_5, fig_3_6, fig_3_7, table_3_2
from cdpr_struct.thesis.reproduction import Reproduction

ITEMS: dict[str, Callable[[], Reproduction]] = {
    "table-2.2": table_2_2,
    "fig-2.4": fig_2_4,
    "table-2.3": table_2_3,
    "table-2.4": table_2_4,
    "table-3.2": table_3_2,
    "fig-3.4": fig_3_4,
    "fig-3.5": fig_3_5,
    "fig-3.6": fig_3_6,
    "fig-3.7": fig_3_7,
    "fig-4.4": fig_4_4,
}
