"""The errors that a user of ratd is meant to see."""


class InputError(ValueError):
    """A value given to ratd is not usable; the message says which one, where, and what is allowed."""


class GrainError(InputError):
    """One grain cannot be used, whatever is asked of it; others can."""


class FileError(OSError):
    """A file is missing, damaged or foreign; the message names the file and what is wrong."""


def is_of_one_grain(error):
    """Whether an error is a matter of the grain at work alone: of its integration, or of its form."""
    return type(error) is RuntimeError or isinstance(error, GrainError)  # other subclasses are errors of the program
