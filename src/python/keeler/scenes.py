"""Scenes as Python gives them: a file, a text, a dictionary, and overrides."""

import json
import math
import operator
import os
from pathlib import Path

import numpy as np

from . import _core
from .errors import UsageError


def _toml(value, place):
    """A value as TOML, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(str(k))} = {_toml(v, f'{place}.{k}')}" for k, v in value.items()) + " }"
    if hasattr(value, "tolist"):  # arrays and numbers of numpy
        return _toml(unmasked(value, place).tolist(), place)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise UsageError(f"{place} is {value}; give a finite number")
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, place) for v in value) + "]"
    raise UsageError(f"{place} is {value!r} ({type(value).__name__}); a scene has texts, numbers, lists and tables")


def _overrides(tables, place):
    lines = []
    for name, value in tables.items():
        path = place + name
        below = _overrides(value, path + ".") if isinstance(value, dict) else None
        lines += below or [f"{path}={_toml(value, path)}"]  # an empty table says something: {"gravity": {}}
    return lines


def _not_too_deep(make):
    """What make() returns. A table may hold itself."""
    try:
        return make()
    except RecursionError:
        raise UsageError("lists or tables inside each other are too deep; a scene has them a few deep") from None


def overrides_of(tables):
    """{"time": {"end": 2}} and {"time.end": 2} as ["time.end=2"]."""
    return _not_too_deep(lambda: _overrides(tables, ""))


def source(scene):
    """(text, name for messages) of a scene: a path, a text with a line break, a dictionary, or a snapshot's."""
    if isinstance(scene, dict):
        lines = _not_too_deep(lambda: [f"{json.dumps(str(key))} = {_toml(value, key)}" for key, value in scene.items()])
        return "\n".join(lines) + "\n", "scene"
    if isinstance(scene, str) and "\n" in scene:
        return scene, "scene"
    try:
        path = Path(scene)
    except TypeError:
        raise UsageError(
            f"a scene cannot be {scene!r}; give the path of a scene file, its text, or a dictionary of its tables"
        ) from None
    try:
        return path.read_text(encoding="utf-8"), str(path)
    except UnicodeDecodeError:
        raise UsageError(f"'{path}' is no text; give the path of a scene file") from None
    except OSError as error:
        raise UsageError(f"cannot read the scene '{path}': {error.strerror}; name a scene file") from None


def whole_number(value, name, least, most):
    """An int of anything that is a whole number."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise UsageError(f"{name} is {value!r}; give a whole number from {least} to {most}")
    return number


def unmasked(value, name):
    """An array as given, None, or a sequence of numbers; refused where entries are masked: the mask would be lost."""
    rows = value if isinstance(value, (list, tuple)) else (value,)
    count = sum(int(np.ma.count_masked(row)) for row in rows if isinstance(row, np.ma.MaskedArray))
    if count:
        raise UsageError(
            f"{name} has {count} masked {'entry' if count == 1 else 'entries'}, and a mask is no number; leave these rows "
            "out of all arrays, or fill them in"
        )
    return value


def read(scene, overrides, start_from=None):
    """The checked scene."""
    text, name = source(scene)
    try:
        return _core.Scene(text, name, overrides_of(overrides), start_from)
    except UsageError as error:
        raise UsageError(str(error).removeprefix("--set ")) from None
