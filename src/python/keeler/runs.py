"""Runs with a folder, sweeps, and what they leave."""

import csv
import io
import json
import os
import shutil
import subprocess
from pathlib import Path

from . import _arguments, _core, _processes, numbers, scenes, snapshots
from .errors import Error, InvariantError, IoError, RunError, UsageError


class Run:
    """The folder of a run, read. ``series`` is a dictionary of arrays, one a column of series.csv, units in the names;
    ``snapshots`` a list of Snapshots, each read when it is asked for; ``summary`` the Numbers of summary.json (None
    while the run works); ``scene`` the resolved scene as text."""

    def __init__(self, folder):
        self.folder = _arguments.path(folder, "Run")
        for needed in ("scene.toml", "snap_000000.hdf"):
            if not (self.folder / needed).is_file():
                raise IoError(f"'{folder}' holds no run ({needed} is missing); name the folder of a run")

    def __repr__(self):
        return f"<keeler.Run: {self.folder}, {len(self.snapshots)} snapshots>"

    @property
    def scene(self):
        return _arguments.text(self.folder / "scene.toml")

    @property
    def series(self):
        return _core.read_series(self.folder / "series.csv")

    @property
    def moonlets(self):
        """The columns of moonlets.csv, as ``series``. Raises IoError where the scene has none."""
        return _core.read_series(self.folder / "moonlets.csv")

    @property
    def summary(self):
        file = self.folder / "summary.json"
        if not file.exists():
            return None
        try:
            values = json.loads(_arguments.text(file), parse_constant=_no_number)
        except (ValueError, RecursionError):
            values = None
        if not isinstance(values, dict):
            raise IoError(f"'{file}' is not the summary of a run; 'keeler resume {self.folder}' writes it again")
        return numbers.Numbers(values, _core.summary_quantities())

    @property
    def snapshots(self):
        return _Snapshots(sorted(self.folder.glob("snap_*.hdf"), key=lambda file: (len(file.name), file.name)))

    def analyze(self, since=None, until=None):
        """The Numbers of ``keeler analyze DIR --json``, a dictionary, from one orbit to another (default: from where
        on the run is steady). Raises UsageError, IoError."""
        return numbers.Numbers(*_core.analyze(self.folder, since, until))


class _Snapshots:
    """Files that are read when one is asked for."""

    def __init__(self, files):
        self.files = files

    def __len__(self):
        return len(self.files)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return _Snapshots(self.files[which])
        return snapshots.read(self.files[which])


def _no_number(name):
    raise ValueError(name)  # NaN and Infinity, which JSON has not


def read(path):
    """A snapshot file as a Snapshot, the folder of a run as a Run. Raises IoError, UsageError."""
    path = _arguments.path(path, "read")
    if path.is_dir():
        return Run(path)
    if not path.exists():
        raise IoError(f"there is no '{path}'; name a snapshot or the folder of a run")
    return snapshots.read(path)


def program():
    """The path of the program ``keeler`` of this version. Raises RunError."""
    package = Path(__file__).parent  # not resolved: in a build, links to the sources stand here
    installed = [prefix / "bin" / "keeler" for prefix in list(package.parents)[3:4]]  # PREFIX/lib/python3/dist-packages
    for place in (package / "bin" / "keeler", package.parent.parent / "keeler", *installed, shutil.which("keeler")):
        if place and Path(place).is_file() and os.access(place, os.X_OK):
            said = subprocess.run([place, "--version"], capture_output=True, check=False).stdout.split()
            if said[-1:] == [_core.version().encode()]:
                return str(place)
    raise RunError(f"the program keeler {_core.version()} is not there; install it beside the package, or add it to PATH")


def _call(arguments):
    """Runs the program; its errors as exceptions."""
    code, said = _processes.said_by([program(), *map(str, arguments)])
    if code == 0:
        return
    kind = {2: UsageError, 3: InvariantError, 4: IoError}.get(code, RunError)
    lines = [line[len("keeler: ") :] for line in said.splitlines() if line.startswith("keeler: ")]
    raise kind(lines[-1] if lines else f"keeler ended with {code}")


def run(scene, folder, *, start=None, force=False, **overrides):
    """``keeler run SCENE -o FOLDER``: a run with series, snapshots and checkpoints, in a process of its own.

    ``start`` is what to start from, as of a Simulation. Returns its Run: ``run.series``, ``run.analyze()`` with all
    viscosities. A folder that holds a run is refused unless ``force``. Ctrl-C stops it with a checkpoint;
    ``keeler resume FOLDER`` goes on. Raises as the program ends: UsageError, InvariantError, IoError, RunError.
    """
    folder = _arguments.path(folder, "run")
    with _processes.folder() as place:
        file, source = place / "scene.toml", []
        if start is not None:
            start = snapshots.as_snapshot(start)
            start.save(place / "start.hdf")
            source = ["--from", place / "start.hdf"]
        file.write_text(scenes.read(scene, overrides, start and start._name).text, encoding="utf-8")
        _call(["run", file, "-o", folder, *source, *(["--force"] if force else [])])
    return Run(folder)


def sweep(grid, folder, *, jobs=None, quantities=()):
    """``keeler sweep GRID -o FOLDER``: many runs, each a process. What is finished already is not run again.

    ``grid`` is the path of a grid's file, or a dictionary of what it holds, whose ``"scene"`` may be a dictionary too.
    Paths in a dictionary are relative to the current folder.

    ``quantities`` are names of numbers of ``analyze()`` that the tables have besides those of every sweep.

    Returns {"runs": rows of sweep.csv, "points": rows of points.csv} as lists of dictionaries, numbers as floats, what is not known as None. Raises
    UsageError for a grid that cannot be, RunError when runs failed (sweep.csv says which).
    """
    folder = _arguments.path(folder, "sweep")
    with _processes.folder() as place:
        grid = _written(grid, place) if isinstance(grid, dict) else _arguments.path(grid, "sweep")
        try:
            names = [quantities] if isinstance(quantities, str) else [str(name) for name in quantities]
            more = ["--quantities", ",".join(names)] if names else []
            _call(["sweep", grid, "-o", folder, *(["--jobs", jobs] if jobs else []), *more])
        except Error as error:
            raise type(error)(str(error).replace(f"{place}{os.sep}", "")) from None
    return {name: _rows(folder / file) for name, file in (("runs", "sweep.csv"), ("points", "points.csv"))}


def _written(grid, place):
    """The file of a grid that is a dictionary."""
    scene = grid.get("scene")
    if isinstance(scene, dict):
        (place / "scene.toml").write_text(scenes.source(scene)[0], encoding="utf-8")
        grid = {**grid, "scene": "scene.toml"}
    elif scene is not None:
        grid = {**grid, "scene": os.path.abspath(_arguments.path(scene, "sweep"))}
    (place / "grid.toml").write_text(scenes.source(grid)[0], encoding="utf-8")
    return place / "grid.toml"


def _rows(file):
    def value(text):
        if text in ("true", "false"):
            return text == "true"
        try:
            return float(text)
        except ValueError:
            return text or None

    if not file.exists():
        return []
    try:
        names, *rows = [row for row in csv.reader(io.StringIO(_arguments.text(file), newline="")) if row]
    except (csv.Error, ValueError):
        names, rows = [], []
    if any(len(row) != len(names) for row in rows) or not names:
        raise IoError(f"'{file}' is not the table of a sweep; the same sweep again writes it again")
    return [dict(zip(names, map(value, row))) for row in rows]


def render(what, file=None, **look):
    """The picture of a Snapshot, a Simulation, a snapshot file or the last state of a run's folder: see
    Snapshot.plot()."""
    if not hasattr(what, "plot"):
        if not isinstance(what, Run):
            what = read(what)
        if isinstance(what, Run):
            what = what.snapshots[-1]
    return what.plot(file, **look)


