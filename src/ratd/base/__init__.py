"""What everything else stands on: errors, units, materials, statistics, flags of compiled code."""
