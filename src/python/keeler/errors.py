"""Errors of Keeler: the one line that the program would print, as exceptions of four kinds."""


class Error(Exception):
    """What all errors of Keeler are; ``exit_code`` is the one that the program would end with."""

    exit_code = 1


class UsageError(Error, ValueError):
    """A scene, an argument or an array that cannot be: what, where, and what to do."""

    exit_code = 2


class InvariantError(Error, ArithmeticError):
    """A state that physics does not allow: particles inside each other, an element that is not a number."""

    exit_code = 3


class IoError(Error, OSError):
    """A file that could not be read or written."""

    exit_code = 4


class RunError(Error, RuntimeError):
    """Anything else that ends a computation: wakes that never settle, a simulation that cannot go on."""

    exit_code = 1
