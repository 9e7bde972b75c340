"""Old name of `pairs`, for `ratd.pipeline`, which is being rewritten; to be removed when that is merged."""

from ratd.experiments.spin_up.pairs import PAIR_COLUMNS

__all__ = ["PAIR_COLUMNS"]
