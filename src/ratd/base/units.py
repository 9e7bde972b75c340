"""Multiples of SI units that appear in configuration files, tables and figures. Inside ratd everything is SI."""

NM = 1e-9
"""Nanometre in m."""
PS = 1e-12
"""Picosecond in s."""
MJ_PER_M2 = 1e-3
"""Millijoule per square metre in J m-2."""
GPA = 1e9
"""Gigapascal in Pa."""
