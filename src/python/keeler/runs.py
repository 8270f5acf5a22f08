"""Runs in folders, sweeps, and their results."""

import csv
import io
import json
import os
import shutil
import subprocess
from pathlib import Path

from . import _arguments, _core, _processes, numbers, own, scenes, snapshots, tables
from .errors import Error, InvariantError, IoError, RunError, UsageError


class Run:
    """The results in the folder of a run. ``series`` are Columns: a dictionary of arrays, one per column of
    series.csv, with units in the names; ``snapshots`` is a list of Snapshots, each read on access; ``summary`` the Numbers of
    summary.json (None while the run works); ``scene`` the resolved scene as text."""

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
        return tables.Columns(_core.read_series(self.folder / "series.csv"))

    @property
    def moonlets(self):
        """The columns of moonlets.csv, as ``series``. Raises IoError if the scene has no moonlets."""
        return tables.Columns(_core.read_series(self.folder / "moonlets.csv"))

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

    def resume(self, until=None):
        """Continues the run from its newest checkpoint, to the scene's end or ``until`` (orbits), as ``keeler resume``
        but in this process, which must know its physics. Returns the run. Raises UsageError, InvariantError, IoError."""
        _core.resume_run(self.folder, until)
        return self

    def analyze(self, since=None, until=None):
        """Returns the Numbers of ``keeler analyze DIR --json``, a dictionary, between two orbits (default: the steady
        part of the run). Raises UsageError, IoError."""
        return numbers.Numbers(*_core.analyze(self.folder, since, until))


class _Snapshots:
    """A sequence of snapshot files that are read on access."""

    def __init__(self, files):
        self.files = files

    def __len__(self):
        return len(self.files)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return _Snapshots(self.files[which])
        return snapshots.read(self.files[which])


def _no_number(name):
    raise ValueError(name)  # NaN and Infinity are not JSON


def read(path):
    """Reads a snapshot file as a Snapshot, or the folder of a run as a Run. Raises IoError, UsageError."""
    path = _arguments.path(path, "read")
    if path.is_dir():
        return Run(path)
    if not path.exists():
        raise IoError(f"there is no '{path}'; name a snapshot or the folder of a run")
    return snapshots.read(path)


def program():
    """Returns the path of the program ``keeler`` of this version. Raises RunError."""
    package = Path(__file__).parent  # not resolved: a build has links to the sources here
    installed = [prefix / "bin" / "keeler" for prefix in list(package.parents)[3:4]]  # PREFIX/lib/python3/dist-packages
    for file in (package / "bin" / "keeler", package.parent.parent / "keeler", *installed, shutil.which("keeler")):
        if file and Path(file).is_file() and os.access(file, os.X_OK):
            words = subprocess.run([file, "--version"], capture_output=True, check=False).stdout.split()
            if words[-1:] == [_core.version().encode()]:
                return str(file)
    raise RunError(f"the program keeler {_core.version()} was not found; install it beside the package, or add it to PATH")


def _call(arguments):
    """Runs the program. Raises its errors as exceptions."""
    code, messages = _processes.run_process([program(), *map(str, arguments)])
    if code == 0:
        return
    kind = {2: UsageError, 3: InvariantError, 4: IoError}.get(code, RunError)
    lines = [line[len("keeler: ") :] for line in messages.splitlines() if line.startswith("keeler: ")]
    raise kind(lines[-1] if lines else f"keeler ended with {code}")


def run(scene, folder, *, start=None, force=False, **overrides):
    """Runs ``keeler run SCENE -o FOLDER`` in a separate process: a run with series, snapshots and checkpoints.

    ``start`` is the initial state, as of a Simulation. Returns the Run: ``run.series``, ``run.analyze()`` with all
    viscosities. A folder with a run is refused unless ``force``. Ctrl-C stops the run with a checkpoint;
    ``keeler resume FOLDER`` continues it. Raises the program's error: UsageError, InvariantError, IoError, RunError.

    A scene with physics of your own (``add_force``, ...) runs in this process, which alone knows it, and so does every
    scene after ``add_series_column``; ``run.resume()`` continues such a run.
    """
    folder = _arguments.path(folder, "run")
    with _processes.folder() as temporary:
        file, source = temporary / "scene.toml", []
        if start is not None:
            start = snapshots.as_snapshot(start)
            start.save(temporary / "start.hdf")
            source = ["--from", temporary / "start.hdf"]
        checked = scenes.read(scene, overrides, start and start._name)
        if own.needs_this_process(checked.text):
            if start is not None:
                checked = scenes.read(scene, overrides, temporary / "start.hdf")
            _core.start_run(checked, folder, force)
            return Run(folder)
        file.write_text(checked.text, encoding="utf-8")
        _call(["run", file, "-o", folder, *source, *(["--force"] if force else [])])
    return Run(folder)


def sweep(grid, folder, *, jobs=None, quantities=()):
    """Runs ``keeler sweep GRID -o FOLDER``: many runs, each a process. Finished runs are not repeated.

    ``grid`` is the path of a grid file, or a dictionary with its content, in which ``"scene"`` may be a dictionary
    too. Paths in a dictionary are relative to the current folder.

    ``quantities`` are names of numbers of ``analyze()``, as further columns of the tables.

    Returns {"runs": rows of sweep.csv, "points": rows of points.csv} as Rows: lists of dictionaries, with numbers as
    floats and unknown values as None. Raises UsageError for an invalid grid, RunError when runs failed (sweep.csv lists
    them).
    """
    folder = _arguments.path(folder, "sweep")
    with _processes.folder() as temporary:
        grid = _written(grid, temporary) if isinstance(grid, dict) else _arguments.path(grid, "sweep")
        try:
            names = [quantities] if isinstance(quantities, str) else [str(name) for name in quantities]
            more = ["--quantities", ",".join(names)] if names else []
            _call(["sweep", grid, "-o", folder, *(["--jobs", jobs] if jobs else []), *more])
        except Error as error:
            raise type(error)(str(error).replace(f"{temporary}{os.sep}", "")) from None
    return {name: _rows(folder / file) for name, file in (("runs", "sweep.csv"), ("points", "points.csv"))}


def _written(grid, target):
    """Writes a grid that is a dictionary into the folder ``target``, and returns its file."""
    scene = grid.get("scene")
    if isinstance(scene, dict):
        (target / "scene.toml").write_text(scenes.source(scene)[0], encoding="utf-8")
        grid = {**grid, "scene": "scene.toml"}
    elif scene is not None:
        grid = {**grid, "scene": os.path.abspath(_arguments.path(scene, "sweep"))}
    (target / "grid.toml").write_text(scenes.source(grid)[0], encoding="utf-8")
    return target / "grid.toml"


def _rows(file):
    def value(text):
        if text in ("true", "false"):
            return text == "true"
        try:
            return float(text)
        except ValueError:
            return text or None

    if not file.exists():
        return tables.Rows()
    try:
        names, *rows = [row for row in csv.reader(io.StringIO(_arguments.text(file), newline="")) if row]
    except (csv.Error, ValueError):
        names, rows = [], []
    if any(len(row) != len(names) for row in rows) or not names:
        raise IoError(f"'{file}' is not the table of a sweep; the same sweep again writes it again")
    return tables.Rows(dict(zip(names, map(value, row))) for row in rows)


def render(what, file=None, **options):
    """Returns the picture of a Snapshot, a Simulation, a snapshot file or the last state in a run's folder: see
    Snapshot.plot()."""
    if not hasattr(what, "plot"):
        if not isinstance(what, Run):
            what = read(what)
        if isinstance(what, Run):
            what = what.snapshots[-1]
    return what.plot(file, **options)


