"""Old name of `cut_bound`, for `run`, which is being rewritten; to be removed when that is merged."""

from ratd.experiments.spin_up.cut_bound import cut_bound

__all__ = ["cut_bound"]
