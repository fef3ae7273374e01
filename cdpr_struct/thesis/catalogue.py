"""Every thesis item that can be recomputed, by name, in the order of the thesis."""

from collections.abc import Callable

from cdpr_struct.thesis.cable_profiles import fig_2_4
from cdpr_struct.thesis.cable_tables import table_2_2, table_2_3, table_2_4
from cdpr_struct.thesis.cogiro_vibration import fig_4_7, fig_4_8, fig_4_9, fig_4_10, table_4_5, table_4_6
from cdpr_struct.thesis.force_tables import fig_5_4, fig_5_5, fig_5_6, table_4_4, table_5_3
from cdpr_struct.thesis.load_thresholds import fig_4_4
from cdpr_struct.thesis.pose_errors import fig_3_4, fig_3_5, fig_3_6, fig_3_7, table_3_2
from cdpr_struct.thesis.reproduction import Reproduction
from cdpr_struct.thesis.vibration import fig_2_5, fig_3_8, fig_3_9

ITEMS: dict[str, Callable[[], Reproduction]] = {
    "table-2.2": table_2_2,
    "fig-2.4": fig_2_4,
    "table-2.3": table_2_3,
    "table-2.4": table_2_4,
    "fig-2.5": fig_2_5,
    "table-3.2": table_3_2,
    "fig-3.4": fig_3_4,
    "fig-3.5": fig_3_5,
    "fig-3.6": fig_3_6,
    "fig-3.7": fig_3_7,
    "fig-3.8": fig_3_8,
    "fig-3.9": fig_3_9,
    "fig-4.4": fig_4_4,
    "table-4.4": table_4_4,
    "table-4.5": table_4_5,
    "table-4.6": table_4_6,
    "fig-4.7": fig_4_7,
    "fig-4.8": fig_4_8,
    "fig-4.9": fig_4_9,
    "fig-4.10": fig_4_10,
    "fig-5.4": fig_5_4,
    "table-5.3": table_5_3,
    "fig-5.5": fig_5_5,
    "fig-5.6": fig_5_6,
}
