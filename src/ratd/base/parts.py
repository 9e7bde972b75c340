"""Parts of the engine that are chosen by their type: laws, drives, boxes, integrators.

A part is a NamedTuple with methods, marked by `part`. Its fields are the options that a user sets; its methods can be
called from compiled code, which numba compiles anew for each combination of parts. So the time loop calls
``law.forces(...)`` without knowing which laws there are, and what a part leaves empty costs nothing.
"""

import inspect

from numba.core import types
from numba.core.errors import TypingError
from numba.extending import overload_method

__all__ = ["part"]

FLAGS = dict(error_model="numpy", fastmath={"contract"}, nogil=True)
"""error_model: a division by zero gives inf, as in numpy; the check for it would block vectorisation. contract: a*b + c
may become one fused instruction. Nothing else is relaxed, so results repeat bit for bit."""

_signatures = {}


def part(cls):
    """Make the methods of a NamedTuple known to compiled code; a decorator.

    Parameters
    ----------
    cls : type
        A NamedTuple with at least one field. A method has the same names of arguments in every part.

    Returns
    -------
    type
        The same.
    """
    for name, method in vars(cls).items():
        if inspect.isfunction(method) and not name.startswith("_"):
            signature = inspect.signature(method)
            if name not in _signatures:
                _signatures[name] = signature
                _offer(name, signature)
            elif list(signature.parameters) != list(_signatures[name].parameters):
                raise TypeError(f"{cls.__name__}.{name}{signature} must have the arguments {_signatures[name]}")
    return cls


def _offer(name, signature):
    def choose(self, *arguments):
        method = getattr(self.instance_class, name, None)
        if not inspect.isfunction(method):
            raise TypingError(f"{self.instance_class.__name__} has no method {name}")
        return method

    choose.__signature__ = signature
    # a tuple whose fields are all of one type is of another kind to numba
    for kind in (types.NamedTuple, types.NamedUniTuple):
        overload_method(kind, name, jit_options=FLAGS)(choose)
