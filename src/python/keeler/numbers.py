"""Measured numbers, with names, units and meanings."""

from typing import NamedTuple

from . import _core
from .errors import UsageError


class Quantity(NamedTuple):
    """Description of a number of ``analyze()``: its name, unit and meaning, and the name of its standard error or
    scatter, or of that in SI (None without one)."""

    name: str
    unit: str
    meaning: str
    spread: "str | None"


def quantities():
    """Returns all numbers of ``analyze()``, in their order: a dictionary of names and Quantities."""
    return {name: Quantity(name, *about[:3]) for name, about in _core.quantities().items()}


class Numbers(dict):
    """Numbers by name; the names end in their units, and unknown numbers are None. A name with a dot,
    "clusters.count", is ``numbers["clusters"]["count"]``."""

    def __init__(self, values, about):
        super().__init__(values)
        self._about = about

    def quantity(self, name):
        """Returns the Quantity of that name: unit and meaning. Raises UsageError."""
        if name not in self._about:
            raise UsageError(f"there is no number '{name}' here; keeler.quantities() lists them with their units")
        return Quantity(name, *self._about[name][:3])

    def error(self, name):
        """Returns the standard error or the scatter of a number, in the number's unit; None if unknown. Raises
        UsageError."""
        spread, si = self.quantity(name).spread, self._about[name][3]
        if spread is None or self.get(spread) is None or not self.get(si):
            return None
        return self[spread] * (self[name] / self[si])


Numbers.__doc__ += "\n\n" + "\n".join(
    f"{q.name}{f' ({q.unit})' if q.unit else ''}: {q.meaning}" for q in quantities().values()
)
