"""How far two builds of Keeler agree: scripts/compare-builds.

    compare_builds.py KEELER KEELER

Six small scenes with all that a step can have. The runs of a scene write a snapshot after each kick interval: the first that
differs in a bit says when the builds part, the two ends how far they have come. Each program also runs each scene twice, so that
a difference is one of the builds."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

from scenes import SCENE, SCENES

NAMES = ["tree", "direct, friction", "fft, moonlet, contacts", "no gravity, newton-relative", "tree, automatic steps",
         "unequal sizes, linear-cubic, contacts"]
STEP = 4e-3  # orbits, of the scenes
END = 0.4


def run(program, name, scene, folder):
    every = 64 / 4096 if "automatic" in name else STEP
    sets = SCENES[name] + [f"output.snapshot_every={every}", f"time.end={END}"]
    words = [program, "run", str(scene), "-o", str(folder), "-q", *(w for s in sets for w in ("--set", s))]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"})
    return json.loads((folder / "summary.json").read_text())["state_hash"]


def load(file):
    with h5py.File(file) as snapshot:
        return (float(snapshot["RingBox"].attrs["time_orbits"]), snapshot["PartType1/Coordinates"][()],
                snapshot["PartType1/Velocities"][()], float(snapshot["RingBox"].attrs["L_x"]),
                float(snapshot["PartType1/Radius"][()].mean()))


def difference(file, other):
    """Orbits, whether all bits agree, and the largest distance (mean radii) of places that no edge of the box lies between."""
    orbits, places, velocities, size, radius = load(file)
    _, other_places, other_velocities, _, _ = load(other)
    same = np.array_equal(places, other_places) and np.array_equal(velocities, other_velocities)
    distances = np.linalg.norm(places - other_places, axis=1)
    return orbits, same, distances[distances < 0.5 * size].max() / radius


def compare(programs, name, scene, work):
    folders = [work / f"{k}" for k in range(4)]
    hashes = [run(programs[k // 2], name, scene, folder) for k, folder in enumerate(folders)]
    if hashes[0] != hashes[1] or hashes[2] != hashes[3]:
        sys.exit(f"compare-builds: {name}: one program gives two results")
    pairs = [(file, folders[2] / file.name) for file in sorted(folders[0].glob("snap_*.hdf"))]
    found = [difference(file, other) for file, other in pairs]
    last = found[-1][2]
    parted = next(((orbits, apart) for orbits, same, apart in found if not same), None)
    if parted is None:
        same = "the same bits" if hashes[0] == hashes[2] else "the same bits in snapshots, another state_hash"
        return f"| {name} | {same} | | |"
    orbits, apart = parted
    return f"| {name} | orbit {orbits:.4g} of {END:g} | {apart:.1e} | {last:.1e} |"


def main():
    programs = sys.argv[1:3]
    print("| scene | first snapshot that differs | by (radii) | at the end by (radii) |\n|---|---|---|---|")
    for name in NAMES:
        with tempfile.TemporaryDirectory() as work:
            scene = Path(work) / "scene.toml"
            scene.write_text(SCENE)
            print(compare(programs, name, scene, Path(work)), flush=True)


if __name__ == "__main__":
    main()
