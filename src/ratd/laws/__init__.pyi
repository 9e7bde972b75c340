"""Types of `ratd.laws`, whose names are loaded on first use."""

from typing import Any, Literal

def dmt(
    *,
    viscous_time: float | None = None,
    friction: Literal["none", "velocity", "spring"] = "velocity",
    friction_time: float = 0.0,
    sliding_limit: float = 1.0,
    rolling_limit: float = 1.0,
    twisting_limit: float = 1.0,
) -> Any: ...
def jkr(
    *,
    normal_force: Literal["JKR", "DMT"] = "JKR",
    damping: Literal["viscoelastic", "constant", "none"] = "viscoelastic",
    constant_damping: float = 0.01,
    friction: Literal["springs", "none"] = "springs",
    sliding_stiffness: float = 1.0,
    sliding_limit: float = 1.0,
    twisting_stiffness: float = 1.0,
) -> Any: ...
