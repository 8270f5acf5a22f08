"""Tables of runs and sweeps, and what their columns mean; as objects of pandas and xarray where these are installed."""

import importlib
import sys

import numpy as np

from . import _core
from .errors import UsageError
from .numbers import Quantity

#: Columns of sweeps beside the keys of the axes and the numbers that are measured: unit, meaning.
_OF_SWEEPS = {
    "run": ("", "name of the run's folder"),
    "seed": ("", "particles.seed of the run"),
    "status": ("", "finished or failed"),
    "reason": ("", "why it failed"),
    "particle_count": ("", "number of particles"),
    "since_orbit": ("orbits", "where the measured part begins"),
    "until_orbit": ("orbits", "where the measured part ends"),
    "steady": ("", "whether the measured part is steady"),
    "finished_runs": ("", "runs of this point that have finished"),
    "failed_runs": ("", "runs of this point that have failed"),
    "steady_runs": ("", "runs of this point that are steady"),
    "collisions_per_particle_orbit": ("", "collisions faster than v_cut"),
    "largest_cluster_mass_share": ("", "mass fraction of the largest cluster of touching spheres, in the last snapshot"),
}


def _of_columns(name):
    """Returns the Quantity of a column of a run's tables; a program may have added one that is not known here."""
    return Quantity(name, *_core.column_quantities(True).get(name, ("", "")), None)


def _of_rows(name):
    """Returns the Quantity of a column of a sweep's tables."""
    known = {**_core.column_quantities(True), **_core.column_quantities(False), **_OF_SWEEPS}  # measured ones are means
    base = name.replace("_error", "")
    if name in known:
        return Quantity(name, *known[name], None)
    if base in known:
        return Quantity(name, known[base][0], f"standard error of {base}", None)
    return Quantity(name, "", "key of the scene", None)


def _imported(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(f"this needs {name}, which {sys.executable} lacks; install it there (Debian: python3-{name})") from None


class _Table:
    """What both kinds of tables have: names of columns, and the columns that are dimensions of an xarray Dataset."""

    def quantity(self, name):
        """Returns the Quantity of a column: its unit and meaning. Raises UsageError."""
        if name not in self._names():
            raise UsageError(f"there is no column '{name}' here; the columns are {', '.join(self._names())}")
        return self._quantity(name)

    def to_pandas(self):
        """Returns a pandas.DataFrame. Its ``attrs["units"]`` and ``attrs["meanings"]`` are dictionaries by column; unknown
        numbers are NaN. Raises ImportError without pandas."""
        frame = _imported("pandas").DataFrame(self._columns())
        about = {name: self._quantity(name) for name in self._names()}
        frame.attrs["units"] = {name: quantity.unit for name, quantity in about.items()}
        frame.attrs["meanings"] = {name: quantity.meaning for name, quantity in about.items()}
        return frame

    def to_xarray(self):
        """Returns an xarray.Dataset. Its dimensions are the time (series), time and id (moonlets), or the keys of the
        axes (points of a sweep) and the seed (its runs); a point that is missing is NaN. Each variable has the
        attributes ``units`` and ``long_name``. Raises ImportError without xarray."""
        xarray = _imported("xarray")
        data = xarray.Dataset.from_dataframe(self.to_pandas().set_index(self._dimensions()))
        for name in data.variables:
            about = self._quantity(str(name))
            data[name].attrs = {"units": about.unit, "long_name": about.meaning}
        return data


class Columns(_Table, dict):
    """A table of a run: a dictionary of arrays, one per column, with units in the names."""

    _quantity = staticmethod(_of_columns)

    def _names(self):
        return list(self)

    def _columns(self):
        return dict(self)

    def _dimensions(self):
        return ["time_orbits", "id"] if "id" in self else ["time_orbits"]


class Rows(_Table, list):
    """A table of a sweep: a list of dictionaries, one per run or point. Unknown values are None."""

    _quantity = staticmethod(_of_rows)

    def _names(self):
        return list(self[0]) if self else []

    def _columns(self):
        return {name: [_known(row[name]) for row in self] for name in self._names()}

    def _dimensions(self):
        names = self._names()
        if "finished_runs" in names:
            return names[: names.index("finished_runs")]
        return names[1 : names.index("seed") + 1]


def _known(value):
    return np.nan if value is None else value
