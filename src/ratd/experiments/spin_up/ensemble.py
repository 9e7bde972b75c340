"""Old name of `grain_table`, for `ratd.pipeline`, which is being rewritten; to be removed when that is merged."""

from ratd.experiments.spin_up.grain_table import COLUMNS
from ratd.geometry.shape import spin_share

__all__ = ["COLUMNS", "spin_share"]
