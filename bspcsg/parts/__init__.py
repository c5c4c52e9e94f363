"""Standard parts: metric threads, bolts and nuts, involute gears, snap fits.

Dimensions are in millimetres. Matching parts do not overlap: a nut and its bolt, two gears of one
module, a hook and its socket.

Examples
--------
>>> import bspcsg as csg
>>> bolt, nut = csg.parts.hex_bolt("M8", 30), csg.parts.hex_nut("M8").translate(0, 0, 20)
>>> bolt.isdisjoint(nut)
True
"""

from .fasteners import hex_bolt, hex_nut
from .gears import spur_gear
from .metric import METRIC, MetricSize, metric
from .snaps import snap_hook, snap_socket, snap_strain
from .threads import tap, threaded_rod

__all__ = [
    "METRIC",
    "MetricSize",
    "hex_bolt",
    "hex_nut",
    "metric",
    "snap_hook",
    "snap_socket",
    "snap_strain",
    "spur_gear",
    "tap",
    "threaded_rod",
]
