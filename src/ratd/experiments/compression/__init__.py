"""Static compression: a fluffy cluster in a periodic box that shrinks slowly, and in one that grows."""
