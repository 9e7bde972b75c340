"""Words in texts and titles."""

__all__ = ["plural"]


def plural(n, word):
    """Such as '1 grain', '30 grains'."""
    return f"{n} {word}" if n == 1 else f"{n} {word}s"
