"""Contact laws: pure functions of one contact."""
