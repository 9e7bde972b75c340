"""ratd: rotational disruption of porous dust aggregates."""
