"""Scenes from Python: a file, a text or a dictionary, and overrides."""

import json
import math
import operator
import os

from . import _arguments, _core
from .errors import UsageError


def _text(value, place):
    if not isinstance(value, str):  # a path of bytes
        raise UsageError(f"{place} is {value!r}; give it as a text")
    return json.dumps(_arguments.whole_characters(value, place), ensure_ascii=False)


def _toml(value, place):
    """Returns a value as TOML, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return _text(os.fspath(value), place)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_text(str(k), place)} = {_toml(v, f'{place}.{k}')}" for k, v in value.items()) + " }"
    if hasattr(value, "tolist"):  # arrays and numbers of numpy
        return _toml(_arguments.unmasked(value, place).tolist(), place)
    if isinstance(value, int):
        if value.bit_length() > 1000:  # Python refuses to convert it
            raise UsageError(f"{place} is a number of more than 300 digits; lower it")
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise UsageError(f"{place} is {value}; give a finite number")
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, place) for v in value) + "]"
    raise UsageError(f"{place} is {_arguments.shown(value)} ({type(value).__name__}); a scene has texts, numbers, lists and tables")


def _overrides(tables, place):
    lines = []
    for name, value in tables.items():
        path = place + _arguments.whole_characters(str(name), "the name of a key")
        below = _overrides(value, path + ".") if isinstance(value, dict) else None
        lines += below or [f"{path}={_toml(value, path)}"]  # an empty table has a meaning: {"gravity": {}}
    return lines


def _not_too_deep(make):
    """Returns make(). Raises UsageError for a table that contains itself."""
    try:
        return make()
    except RecursionError:
        raise UsageError("lists or tables inside each other are too deep; a scene has them a few deep") from None


def overrides_of(tables):
    """Converts {"time": {"end": 2}} or {"time.end": 2} to ["time.end=2"]."""
    return _not_too_deep(lambda: _overrides(tables, ""))


def _is_no_file(path, name):
    """Returns whether a text is the name of an example, or of nothing else."""
    return name.replace("-", "").isalnum() and not path.is_file() and (_core.is_example(name) or not path.exists())


def source(scene):
    """Returns (text, name) of a scene: a path, the name of an example, a text with a line break, a dictionary, or a
    snapshot's scene. Paths in the scene are relative to the name; the name of a path is bytes, which need not be UTF-8."""
    if isinstance(scene, dict):
        lines = _not_too_deep(lambda: [f"{_text(str(k), 'a key')} = {_toml(v, str(k))}" for k, v in scene.items()])
        return "\n".join(lines) + "\n", "scene"
    if isinstance(scene, str) and "\n" in scene:
        return _arguments.whole_characters(scene, "the scene"), "scene"
    if not isinstance(scene, (str, os.PathLike)):
        raise UsageError(
            f"a scene cannot be {_arguments.shown(scene)}; give the path of a scene file, its text, or a dictionary of "
            "its tables"
        )
    path = _arguments.path(scene, "a scene")
    if isinstance(scene, str) and _is_no_file(path, scene):
        return _core.example_text(scene), scene
    try:
        return _arguments.content(path).decode("utf-8"), os.fsencode(path)
    except UnicodeDecodeError:
        raise UsageError(f"'{path}' is no text; give the path of a scene file") from None
    except OSError as error:
        raise UsageError(f"cannot read the scene '{path}': {error.strerror}; name a scene file") from None


def whole_number(value, name, low, high):
    """Converts a whole number of any type to int. Raises UsageError unless it is from ``low`` to ``high``."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or not low <= number <= high:
        raise UsageError(f"{name} is {_arguments.shown(value)}; give a whole number from {low} to {high}")
    return number


def read(scene, overrides, start_from=None):
    """Returns the validated scene."""
    text, name = source(scene)
    start_from = None if start_from is None else os.fsencode(start_from)
    return as_arguments(lambda: _core.Scene(text, name, overrides_of(overrides), start_from))


def as_arguments(make):
    """Returns make(). Messages about overrides are reworded for arguments."""
    try:
        return make()
    except UsageError as error:
        raise UsageError(str(error).removeprefix("--set ")) from None
