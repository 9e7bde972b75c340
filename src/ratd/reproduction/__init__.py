"""docs/reproduction.md: the paper's figures, tables and quoted numbers beside ours, from committed data alone."""
