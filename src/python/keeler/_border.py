"""Wrappers of the compiled part: invalid arguments raise errors of one line."""

import functools
import types

from . import _arguments
from .errors import UsageError


def _refusal(owner, name, values):
    """Returns the message for arguments of wrong types."""
    shown = ", ".join(map(_arguments.shown, values))
    what = owner.lower() if name == "__init__" else name
    return f"{what} cannot take {shown or 'no value'}; help() of the function lists its arguments"


def _guarded(owner, name, function):
    @functools.wraps(function)
    def call(*values, **named):
        try:
            return function(*values, **named)
        except TypeError as error:
            if "incompatible" not in str(error) or "arguments" not in str(error):
                raise
            given = [*values[1 if owner else 0 :], *named.values()]
            raise UsageError(_refusal(owner, name, given)) from None

    return call


def guard(module):
    """Wraps all functions of a compiled module, and all methods of its classes."""
    for name, thing in list(vars(module).items()):
        if isinstance(thing, type):
            for method, function in list(vars(thing).items()):
                if isinstance(function, staticmethod):
                    setattr(thing, method, staticmethod(_guarded("", method, getattr(thing, method))))
                elif type(function).__name__ == "instancemethod":
                    setattr(thing, method, _guarded(name, method, function))
        elif isinstance(thing, types.BuiltinFunctionType):
            setattr(module, name, _guarded("", name, thing))
