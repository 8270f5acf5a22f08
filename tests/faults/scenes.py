"""Small runs that use what a run can use, and whether two folders hold the same results to the last bit."""

import json
import threading
from pathlib import Path

import h5py
import numpy as np

from program import Broken

SCENE = """title = "Small patch"
[planet]
preset = "saturn-a-ring"
[box]
size = [32, 32] # m
[particles]
count = 150
density = 600.0 # kg/m^3
[time]
step = 4e-3 # orbits
end = 0.4
[output]
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.02
"""
EQUAL = ["particles.sizes={law='equal',radius=1.0}"]
TREE = EQUAL + ["gravity.solver=tree"]
FFT = EQUAL + ["gravity.solver=fft"]
CONTACTS = ["output.collisions.fraction=0.5"]
FRICTION = ["collisions.friction.tangential_restitution=0.4", "collisions.friction.coefficient=0.5"]
MOONLET = ["moonlet=[{radius=3.0,density=900.0}]"]

# by name: overrides of the scene above
SCENES = {
    "tree": TREE,
    "direct, friction": EQUAL + ["gravity.solver=direct"] + FRICTION,
    "fft, moonlet, contacts": FFT + MOONLET + CONTACTS,
    "no gravity, newton-relative": EQUAL + ["collisions.finder=newton-relative"],
    "tree, kicks every third step, contacts": TREE + ["gravity.kick_every=3"] + CONTACTS,
    "tree, automatic steps": TREE + ["time.step=auto"],
    "fft, satellite": FFT + ["satellite={mass=3.7e10,distance=4000.0,passage=0.2}"],
    "axisymmetric, waves": EQUAL + ["gravity.solver=axisymmetric", "gravity.shortest_wavelength=8.0",
                                    "particles.modes.outward=[[1,0.05,0.0]]"],
    "unequal sizes, linear-cubic, contacts": ["particles.sizes={law='power',exponent=3.0,min=0.5,max=2.0}",
                                              "collisions.finder=linear-cubic"] + CONTACTS,
    "mesh, newton-cubic-cached": EQUAL + ["gravity.solver=mesh", "collisions.finder=newton-cubic-cached"],
    "rings of images, acceleration": EQUAL + ["gravity={solver='tree',images='rings'}",
                                              "constant_acceleration.azimuthal=1e-7"],
    "all at once": FFT + MOONLET + CONTACTS + FRICTION + ["time.step=auto"],
}
RICH = "fft, moonlet, contacts"  # with every kind of file
SHORT = "the same, short"         # with fewer of each
SHORTER = ["time.end=0.08", "output.snapshot_every=0.04", "output.checkpoint_every=0.04"]
OVERRIDES = {**SCENES, SHORT: SCENES[RICH] + SHORTER}


class Scenes:
    """Makes the runs without a fault that others are held against, each once."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = Path(folder)
        self.file = self.folder / "scene.toml"
        self.file.write_text(SCENE)
        self.whole = {}
        self.making = threading.Lock()

    def words(self, name, folder, *more):
        sets = [word for override in OVERRIDES[name] for word in ("--set", override)]
        return ["run", self.file, "-o", folder, *sets, *more]

    def reference(self, name):
        with self.making:
            if name not in self.whole:
                folder = self.folder / f"whole-{len(self.whole)}"
                self.program.run(*self.words(name, folder), env={"KEELER_SIMD": "portable"}).must_be(0)
                self.whole[name] = folder
            return self.whole[name]


def checkpoints(folder):
    return sorted(Path(folder).glob("checkpoint_*.h5"))


def _datasets(file, group):
    with h5py.File(file) as opened:
        return {name: item[()] for name, item in opened[group].items() if isinstance(item, h5py.Dataset)}


def _same_arrays(file, other, group):
    a, b = _datasets(file, group), _datasets(other, group)
    return a.keys() == b.keys() and all(np.array_equal(a[name], b[name], equal_nan=True) for name in a)


def same_results(file, other):
    """Equal arrays of HDF5 (its attributes say which command made them); other files by their bytes."""
    if file.suffix not in (".hdf", ".h5"):
        return file.read_bytes() == other.read_bytes()
    group = "PartType1" if file.suffix == ".hdf" else "Contacts"
    return _same_arrays(file, other, group)


def must_equal(folder, reference, but=()):
    """The finished run in the folder has all results of the other one, bit for bit, and left no parts of files."""
    folder, reference = Path(folder), Path(reference)
    summary = json.loads((folder / "summary.json").read_text())
    expected = json.loads((reference / "summary.json").read_text())
    if not summary["finished"] or summary["state_hash"] != expected["state_hash"]:
        raise Broken("wrong", f"{folder}: another state")
    for pattern in ("*.csv", "snap_*.hdf", "collisions_*.h5"):
        for other in sorted(reference.glob(pattern)):
            file = folder / other.name
            if file.name in but:
                continue
            if not file.exists():
                raise Broken("lost", f"{file} is missing")
            if not same_results(file, other):
                raise Broken("wrong", f"{file} has other values")
        if len(list(folder.glob(pattern))) != len(list(reference.glob(pattern))):
            raise Broken("wrong", f"{folder}: other files {pattern}")
    parts = list(folder.glob("*.tmp"))
    if parts or len(checkpoints(folder)) != 2:
        raise Broken("wrong", f"{folder}: left over: {parts + checkpoints(folder)}")
    if "log.jsonl" not in but:
        for line in (folder / "log.jsonl").read_text().splitlines():
            json.loads(line)
