"""What is measured, with names, units and meanings."""

from typing import NamedTuple

from . import _core
from .errors import UsageError


class Quantity(NamedTuple):
    """A number that ``analyze()`` gives: its name there, its unit, what it is, and the name of the number that stands
    beside it, or beside the same in SI, as its standard error or its scatter (None without one)."""

    name: str
    unit: str
    meaning: str
    spread: "str | None"


def quantities():
    """All numbers that ``analyze()`` gives, in their order: a dictionary of names and Quantities."""
    return {name: Quantity(name, *about[:3]) for name, about in _core.quantities().items()}


class Numbers(dict):
    """Numbers by their names, which end in their units; what is not known is None. A name with a dot, "clusters.count",
    is ``numbers["clusters"]["count"]``."""

    def __init__(self, values, about):
        super().__init__(values)
        self._about = about

    def quantity(self, name):
        """The Quantity of that name: unit and meaning. Raises UsageError."""
        if name not in self._about:
            raise UsageError(f"there is no number '{name}' here; keeler.quantities() lists them with their units")
        return Quantity(name, *self._about[name][:3])

    def error(self, name):
        """The standard error or the scatter of the number of that name, in its unit; None where none is known. Raises
        UsageError."""
        spread, si = self.quantity(name).spread, self._about[name][3]
        if spread is None or self.get(spread) is None or not self.get(si):
            return None
        return self[spread] * (self[name] / self[si])


Numbers.__doc__ += "\n\n" + "\n".join(
    f"{q.name}{f' ({q.unit})' if q.unit else ''}: {q.meaning}" for q in quantities().values()
)
