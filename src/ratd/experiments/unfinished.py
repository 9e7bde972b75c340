"""What a run has reached when it ends with an error: hours of records are not lost with it."""

from contextlib import contextmanager

__all__ = ["attached"]


@contextmanager
def attached(name, make):
    """A context in which a RuntimeError gets an attribute.

    Parameters
    ----------
    name : str
        Of the attribute.
    make : callable
        ``make(error)`` returns what it holds. An error of the engine has the last state as its attribute ``state``
        (`ratd.engine.step.run`).
    """
    try:
        yield
    except RuntimeError as error:
        setattr(error, name, make(error))
        raise
