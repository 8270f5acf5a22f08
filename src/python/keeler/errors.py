"""Exceptions of four kinds, with the one-line error messages of the program."""


class Error(Exception):
    """Base class of all errors of Keeler; ``exit_code`` is the exit code of the program for this error."""

    exit_code = 1


class UsageError(Error, ValueError):
    """An invalid scene, argument or array. The message says what is wrong, where, and what to do."""

    exit_code = 2


class InvariantError(Error, ArithmeticError):
    """A state that physics does not allow: overlapping particles, an element that is not finite."""

    exit_code = 3


class IoError(Error, OSError):
    """A file that could not be read or written."""

    exit_code = 4


class RunError(Error, RuntimeError):
    """Any other end of a computation: wakes that never settle, a simulation that cannot continue."""

    exit_code = 1
