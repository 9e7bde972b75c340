"""The two errors that a user of ratd is meant to see."""


class InputError(ValueError):
    """A value given to ratd is not usable; the message says which one, where, and what is allowed."""


class FileError(OSError):
    """A file is missing, damaged or foreign; the message names the file and what is wrong."""
