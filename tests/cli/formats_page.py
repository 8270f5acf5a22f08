"""formats_page.py SOURCE_DIR MINIMAL FULL: docs/formats.md, and the table of summary.json in docs/manual/commands.md, against
the folders of two runs: one of a minimal scene, one of a scene with all optional output. Entries without "only" are in both
runs; entries that depend on a setting are in the full run alone; and no run has an entry that is not documented."""

import json
import re
import sys
from pathlib import Path

import h5py

source, minimal, full = map(Path, sys.argv[1:4])
PAGE = (source / "docs/formats.md").read_text()
faults = []


def rows(page, heading, until="\n## "):
    """Yields (names in backticks of the first cell, rest of the row) of the tables below a heading."""
    section = page.split(heading, 1)[1].split(until, 1)[0]
    lines = [line for line in section.splitlines() if line.startswith("| `")]
    cells = (re.split(r" \| ", line.strip("| "), maxsplit=1) for line in lines)
    return [(re.findall(r"`([^`]*)`", first), rest) for first, rest in cells]


def hold(what, documented, in_minimal, in_full):
    """`documented`: {name: True if it is always there}."""
    for name, always in documented.items():
        if name not in in_full:
            faults.append(f"{what}: the full run has no {name}")
        if always and name not in in_minimal:
            faults.append(f"{what}: {name} is not always there")
        if not always and name in in_minimal:
            faults.append(f"{what}: {name} is there without the setting that the page names")
    for name in sorted(set(in_minimal) | set(in_full)):
        if name not in documented:
            faults.append(f"{what}: the page does not know {name}")


def columns(folder, name):
    file = folder / name
    return file.read_text().splitlines()[0].split(",") if file.exists() else []


def table(heading):
    return {names[0]: "only" not in rest.split("; ")[-1] for names, rest in rows(PAGE, heading)}


def numbered(names):
    return {re.sub(r"[0-9]{6}", "NNNNNN", name) for name in names}


files = {
    name: "; only" not in rest for names, rest in rows(PAGE, "# Files\n", "\n## ") for name in names if "." in name
}
for name in ("broken_NNNNNN.hdf", "scene_edited.toml"):  # of no setting
    files.pop(name, None)
hold("the folder", files, *(numbered(file.name for file in folder.iterdir()) for folder in (minimal, full)))

hold("series.csv", table("## Time series"), columns(minimal, "series.csv"), columns(full, "series.csv"))
always = {name: False for name in table("## Moonlets")}
hold("moonlets.csv", always, columns(minimal, "moonlets.csv"), columns(full, "moonlets.csv"))
speeds = PAGE.split("`impact_speeds.csv` counts", 1)[1].split("A sum over rows", 1)[0]
speeds = {name: False for name in re.findall(r"`([a-z_]+)`", speeds)}
hold("impact_speeds.csv", speeds, columns(minimal, "impact_speeds.csv"), columns(full, "impact_speeds.csv"))


def objects(file, group):
    """Datasets and attributes of a group, as the page names them."""
    with h5py.File(file) as image:
        return set(image[group]) | set(image[group].attrs)


snapshots = minimal / "snap_000000.hdf", full / "snap_000000.hdf"
documented = {"PartType1": {}, "Header": {}, "RingBox": {}, "VTKHDF": {"PointData": True, "Points": True}, "Code": None}
for (path, *others), rest in rows(PAGE, "## Snapshots"):
    parts = path.strip("/").split("/")
    known = documented.get(parts[0])
    if known is None:
        continue
    if len(parts) > 1:
        known[parts[1]] = "; only" not in rest
    else:
        names = others + re.findall(r"`([A-Za-z_]+)`", rest)
        known.update({name: True for name in names if name not in ("Points", "PointData")})
for group, known in documented.items():
    if known is not None:
        known = {name: is_always for name, is_always in known.items() if name not in ("Version", "Type")}
        found = [objects(file, group) - {"Version", "Type"} for file in snapshots]
        hold(f"/{group} of snapshots", known, *found)

contacts = full / "collisions_000000.h5"
named = [name.split("/")[-1] for names, _ in rows(PAGE, "## Contacts") for name in names if "/Contacts/" in name or "/" not in name]
with h5py.File(contacts) as image:
    for name in image["Contacts"]:
        if name not in named:
            faults.append(f"/Contacts: the page does not know {name}")

commands = (source / "docs/manual/commands.md").read_text()
summary = {name.split(".")[0]: True for names, _ in rows(commands, "Every run has all of these names", "\n\nA name") for name in names}
summary["provenance"] = True
hold("summary.json", summary, *(list(json.loads((folder / "summary.json").read_text())) for folder in (minimal, full)))

print("\n".join(faults))
sys.exit(bool(faults))
