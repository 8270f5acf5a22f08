"""Checks of common arguments: paths, texts of files, arrays of numbers. Invalid ones raise errors of one line."""

import errno
import os
from pathlib import Path

import numpy as np

from .errors import IoError, UsageError

_MOST_BYTES = 2**28

#: The names of SI units in astropy, yt and pint, without blanks.
_UNITS = {
    "positions": ("m", "meter"),
    "velocities": ("m/s", "meter/second"),
    "radii": ("m", "meter"),
    "masses": ("kg", "kilogram"),
    "spins": ("rad/s", "1/s", "radian/second", "1/second"),
}


def shown(value):
    """Returns a value for a message, shortened."""
    try:
        text = repr(value)
    except ValueError:  # a number with more digits than Python converts
        text = "a number of very many digits"
    return text if len(text) <= 40 else text[:37] + "..."


def path(value, function):
    """Returns the Path of a string or path object. It need not exist."""
    try:
        name = os.fspath(value)
        possible = isinstance(name, str) and name != "" and b"\0" not in os.fsencode(name)
    except (TypeError, UnicodeEncodeError):
        possible = False
    if not possible:
        raise UsageError(f"{function} cannot take {shown(value)}; name a file or folder by a text or a pathlib.Path")
    return Path(name)


def content(file):
    """Returns the bytes of a file, which may be a pipe. Raises OSError."""
    pieces, size = [], 0
    with open(file, "rb") as opened:
        while piece := opened.read(2**20):
            pieces.append(piece)
            size += len(piece)
            if max(size, os.fstat(opened.fileno()).st_size) > _MOST_BYTES:
                raise OSError(errno.EFBIG, f"it is too large (more than {_MOST_BYTES >> 20} MB)")
    return b"".join(pieces)


def text(file):
    """Returns the text of a file of a run or a sweep. Raises IoError."""
    try:
        return content(file).decode("utf-8")
    except UnicodeDecodeError:
        raise IoError(f"'{file}' is no text (it has bytes that are not UTF-8); restore it, or make it again") from None
    except OSError as error:
        raise IoError(f"cannot read '{file}': {error.strerror}") from None


def whole_characters(value, name):
    """Returns a string. Raises UsageError if it has a lone surrogate, which UTF-8 cannot encode."""
    try:
        value.encode("utf-8")
    except UnicodeEncodeError as error:
        raise UsageError(
            f"{name} has half of a character ({value[error.start]!a}, a lone surrogate), which no text in UTF-8 has; "
            "correct or remove it"
        ) from None
    return value


def unmasked(value, name):
    """Returns an array, None, or a sequence of numbers unchanged. Raises UsageError for masked entries: the mask
    would be lost."""
    rows = value if isinstance(value, (list, tuple)) else (value,)
    count = sum(int(np.ma.count_masked(row)) for row in rows if isinstance(row, np.ma.MaskedArray))
    if count:
        raise UsageError(
            f"{name} has {count} masked {'entry' if count == 1 else 'entries'}, and a mask is no number; leave these rows "
            "out of all arrays, or fill them in"
        )
    return value


def doubles(value, name):
    """Converts positions, velocities, radii, masses or spins to an array of doubles; None to None. Raises
    UsageError."""
    if value is None:
        return None
    unit = getattr(value, "unit", getattr(value, "units", None))
    if unit is not None and str(unit).replace(" ", "") not in _UNITS[name]:
        raise UsageError(f"{name} has the unit {shown(str(unit))}; give numbers in SI, here {_UNITS[name][0]}")
    unmasked(value, name)
    try:
        array = np.asarray(value)
    except ValueError:
        raise UsageError(f"{name} has rows of different lengths; give an array of numbers") from None
    if array.dtype.kind not in "fiubO":
        raise UsageError(f"{name} has the type {shown(str(array.dtype))}; give an array of numbers")
    try:
        return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{name} has entries that are no numbers; give an array of numbers") from None


def numbers(value, name, count):
    """Converts so many positive numbers, which may be one array, to a tuple of floats. Raises UsageError."""
    try:
        found = tuple(float(number) for number in np.ravel(np.asarray(value, dtype=float)))
    except (TypeError, ValueError, OverflowError):
        found = ()
    if len(found) != count or not all(0.0 < number < np.inf for number in found):
        raise UsageError(f"{name} is {shown(value)}; give {'a positive number' if count == 1 else f'{count} positive numbers'}")
    return found
