"""Runs with a folder, sweeps, and what they leave."""

import json
import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

from . import _core, scenes, snapshots
from .errors import Error, InvariantError, IoError, RunError, UsageError


class Run:
    """The folder of a run, read. ``series`` is a dictionary of arrays, one a column of series.csv, units in the names;
    ``snapshots`` a list of Snapshots, each read when it is asked for; ``summary`` the numbers of summary.json (None
    while the run works); ``scene`` the resolved scene as text."""

    def __init__(self, folder):
        self.folder = Path(folder)
        for needed in ("scene.toml", "snap_000000.hdf"):
            if not (self.folder / needed).is_file():
                raise IoError(f"'{folder}' holds no run ({needed} is missing); name the folder of a run")

    def __repr__(self):
        return f"<keeler.Run: {self.folder}, {len(self.snapshots)} snapshots>"

    @property
    def scene(self):
        return _text(self.folder / "scene.toml")

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
            return json.loads(_text(file))
        except json.JSONDecodeError:
            raise IoError(f"'{file}' is not the summary of a run; 'keeler resume {self.folder}' writes it again") from None

    @property
    def snapshots(self):
        return _Snapshots(sorted(self.folder.glob("snap_*.hdf"), key=lambda file: (len(file.name), file.name)))

    def analyze(self, since=None, until=None):
        """The numbers of ``keeler analyze DIR --json``, as a dictionary, from one orbit to another (default: from where
        on the run is steady). Raises UsageError, IoError."""
        return json.loads(_core.analyze(self.folder, since, until))


def _text(file):
    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise IoError(f"'{file}' is no text (it has bytes that are not UTF-8); restore it, or make it again") from None
    except OSError as error:
        raise IoError(f"cannot read '{file}': {error.strerror}") from None


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


def read(path):
    """A snapshot file as a Snapshot, the folder of a run as a Run. Raises IoError, UsageError."""
    if not isinstance(path, (str, os.PathLike)):
        raise UsageError(f"{path!r} is no path; name a snapshot or the folder of a run")
    path = Path(path)
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
        if place and Path(place).is_file():
            said = subprocess.run([place, "--version"], capture_output=True, text=True, check=False).stdout.split()
            if said[-1:] == [_core.version()]:
                return str(place)
    raise RunError(f"the program keeler {_core.version()} is not there; install it beside the package, or add it to PATH")


def _call(arguments):
    """Runs the program; its errors as exceptions. Ctrl-C reaches it from here alone, and it takes the time it needs."""
    command = [program(), *map(str, arguments)]
    with subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        try:
            said = process.communicate()[1]
        except BaseException:
            process.send_signal(signal.SIGINT)
            process.communicate()
            raise
    if process.returncode == 0:
        return
    kind = {2: UsageError, 3: InvariantError, 4: IoError}.get(process.returncode, RunError)
    lines = [line[len("keeler: ") :] for line in said.splitlines() if line.startswith("keeler: ")]
    raise kind(lines[-1] if lines else f"keeler ended with {process.returncode}")


def run(scene, folder, *, start=None, force=False, **overrides):
    """``keeler run SCENE -o FOLDER``: a run with series, snapshots and checkpoints, in a process of its own.

    ``start`` is what to start from, as of a Simulation. Returns its Run: ``run.series``, ``run.analyze()`` with all
    viscosities. A folder that holds a run is refused unless ``force``. Ctrl-C stops it with a checkpoint;
    ``keeler resume FOLDER`` goes on. Raises as the program ends: UsageError, InvariantError, IoError, RunError.
    """
    with tempfile.TemporaryDirectory() as place:
        file, source = Path(place) / "scene.toml", []
        if start is not None:
            start = snapshots.as_snapshot(start)
            start.save(Path(place) / "start.hdf")
            source = ["--from", Path(place) / "start.hdf"]
        file.write_text(scenes.read(scene, overrides, start and start._name).text, encoding="utf-8")
        _call(["run", file, "-o", folder, *source, *(["--force"] if force else [])])
    return Run(folder)


def sweep(grid, folder, *, jobs=None):
    """``keeler sweep GRID -o FOLDER``: many runs, each a process. What is finished already is not run again.

    ``grid`` is the path of a grid's file, or a dictionary of what it holds, whose ``"scene"`` may be a dictionary too.
    Paths in a dictionary are relative to the current folder.

    Returns {"runs": rows of sweep.csv, "points": rows of points.csv} as lists of dictionaries, numbers as floats. Raises
    UsageError for a grid that cannot be, RunError when runs failed (sweep.csv says which).
    """
    with tempfile.TemporaryDirectory() as place:
        if isinstance(grid, dict):
            grid = _written(grid, Path(place))
        try:
            _call(["sweep", grid, "-o", folder, *(["--jobs", jobs] if jobs else [])])
        except Error as error:
            raise type(error)(str(error).replace(f"{place}{os.sep}", "")) from None
    return {name: _rows(Path(folder) / file) for name, file in (("runs", "sweep.csv"), ("points", "points.csv"))}


def _written(grid, place):
    """The file of a grid that is a dictionary."""
    scene = grid.get("scene")
    if isinstance(scene, dict):
        (place / "scene.toml").write_text(scenes.source(scene)[0], encoding="utf-8")
        grid = {**grid, "scene": "scene.toml"}
    elif isinstance(scene, (str, os.PathLike)):
        grid = {**grid, "scene": os.path.abspath(scene)}
    (place / "grid.toml").write_text(scenes.source(grid)[0], encoding="utf-8")
    return place / "grid.toml"


def _rows(file):
    import csv
    import io

    def number(text):
        try:
            return float(text)
        except ValueError:
            return text or None

    if not file.exists():
        return []
    rows = csv.DictReader(io.StringIO(_text(file), newline=""))
    return [{name: number(value) for name, value in row.items()} for row in rows]


def render(what, file=None, **look):
    """The picture of a Snapshot, a Simulation, a snapshot file or the last state of a run's folder: see
    Snapshot.plot()."""
    if not hasattr(what, "plot"):
        if not isinstance(what, Run):
            what = read(what)
        if isinstance(what, Run):
            what = what.snapshots[-1]
    return what.plot(file, **look)


