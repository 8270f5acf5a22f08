"""The runs, the tables and the figure of docs/hard-spheres.md, by build/default/keeler: called by scripts/hard-spheres."""

import csv
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy
from matplotlib import pyplot

SOURCE = Path(__file__).resolve().parents[1]
GRIDS = SOURCE / "examples" / "hard-spheres"
RUNS = SOURCE / "runs" / "hard-spheres"
PAGE = SOURCE / "docs" / "hard-spheres.md"
FIGURE = SOURCE / "docs" / "figures" / "hard-spheres.svg"
PROGRAM = SOURCE / "build" / "default" / "keeler"
# r_h of each density, in this planet's A ring
HILL = {159.0: 0.60, 202.0: 0.65, 376.0: 0.80, 591.0: 0.93, 978.0: 1.10, 1270.0: 1.20}


def sweep(grid, more):
    done = subprocess.run([PROGRAM, "sweep", GRIDS / f"{grid}.toml", "-o", RUNS / grid, *more])
    if done.returncode not in (0, 1):  # 1: some runs failed, which the tables say
        sys.exit(done.returncode)


def rows(grid):
    """Of the finished runs, with what their summaries add."""
    found = []
    with open(RUNS / grid / "sweep.csv", newline="") as table:
        for row in csv.DictReader(table):
            if row["status"] != "finished":
                continue
            summary = json.loads((RUNS / grid / "runs" / row["run"] / "summary.json").read_text())
            row["overlap"] = summary["largest_overlap"]
            row["cost"] = 1e6 * summary["cpu_s"] / summary["particle_count"] / summary["steps"]
            row["resting"] = (summary["resting_contacts"] or 0) / summary["particle_count"]
            row["carried"] = row["gravity.resting_contacts"].strip('"') == "carried"
            found.append(row)
    return found


def number(text, digits=3):
    if text in ("", None):
        return "–"
    value = float(text)
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.{digits}g}"


def table(head, body):
    line = "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return line + "".join("| " + " | ".join(cells) + " |\n" for cells in body)


STATE_HEAD = ["contacts at rest", "lost over work of the shear", "c_x, rΩ", "ν, r²Ω", "contacts a particle and orbit",
              "pairs at rest a particle", "overlap", "processor µs a particle and step"]


def state_cells(row):
    balance = f"{float(row['energy_balance']):.3f}" if row["energy_balance"] else "–"
    if row["energy_balance_error"]:
        balance += f" ± {float(row['energy_balance_error']):.1g}"
    return ["carried" if row["carried"] else "bounced", balance, number(row["dispersion_x_r_omega"]),
            number(row["total_viscosity_r2_omega"]), number(row["collisions_per_particle_orbit"]), number(row["resting"], 2),
            number(row["overlap"], 2), number(row["cost"])]


def density(row):
    return float(row["particles.density"])


def states():
    ordered = sorted(rows("states"), key=lambda r: (float(r["particles.optical_depth"]), density(r), r["carried"]))
    return table(["τ", "r_h"] + STATE_HEAD,
                 [[number(r["particles.optical_depth"]), f"{HILL[density(r)]:.2f}"] + state_cells(r) for r in ordered])


def over_seeds(found, column, digits=4):
    """The mean of the seeds ± how far one of them scatters."""
    values = numpy.array([float(r[column]) for r in found if r[column] not in ("", None)])
    if len(values) < 2:
        return number(values[0], digits) if len(values) else "–"
    return f"{number(values.mean(), digits)} ± {number(values.std(ddof=1), 2)}"


def wakes():
    alike = {}
    for row in rows("wakes"):
        alike.setdefault((density(row), row["carried"]), []).append(row)
    columns = (("energy_balance", 4), ("dispersion_x_r_omega", 3), ("total_viscosity_r2_omega", 3),
               ("collisions_per_particle_orbit", 3), ("resting", 2), ("cost", 3))
    return table(["r_h", "contacts at rest", "seeds"] + STATE_HEAD[1:-2] + STATE_HEAD[-1:],
                 [[f"{HILL[key[0]]:.2f}", "carried" if key[1] else "bounced", str(len(found))]
                  + [over_seeds(found, column, digits) for column, digits in columns] for key, found in sorted(alike.items())])


def kicks():
    ordered = sorted(rows("kicks"), key=lambda r: (density(r), int(r["gravity.kick_every"]), r["carried"]))
    return table(["r_h", "kick interval, orbits"] + STATE_HEAD,
                 [[f"{HILL[density(r)]:.2f}", f"{int(r['gravity.kick_every'])}e-3"] + state_cells(r) for r in ordered])


def dense():
    ordered = sorted(rows("dense"), key=lambda r: float(r["particles.optical_depth"]))
    return table(["τ", "kick interval, orbits"] + STATE_HEAD,
                 [[number(r["particles.optical_depth"]), f"{int(r['gravity.kick_every'])}e-3"] + state_cells(r) for r in ordered])


def cuts():
    ordered = sorted(rows("cuts"), key=lambda r: (-float(r["time.step"]), float(r["collisions.elastic_below_speed"]), r["carried"]))
    return table(["step, orbits", "elastic below, rΩ"] + STATE_HEAD,
                 [[r["time.step"], r["collisions.elastic_below_speed"]] + state_cells(r) for r in ordered])


def random_speed(run):
    """In rΩ: of the pile's last snapshot, beyond its motion and rotation as one body."""
    with tempfile.TemporaryDirectory() as folder:
        particles = Path(folder) / "particles.csv"
        subprocess.run([PROGRAM, "convert", max(run.glob("snap_*.hdf")), "--to", "csv", "-o", particles], check=True,
                       stdout=subprocess.DEVNULL)
        rows = numpy.genfromtxt(particles, delimiter=",", names=True)
    place, speed = (numpy.stack([rows[name] for name in names], axis=1)
                    for names in (("x_m", "y_m", "z_m"), ("vx_m_s", "vy_m_s", "vz_m_s")))
    mass = rows["m_kg"][:, None]
    place, speed = place - (mass * place).sum(0) / mass.sum(), speed - (mass * speed).sum(0) / mass.sum()
    inertia = (mass[:, :, None] * ((place**2).sum(1)[:, None, None] * numpy.eye(3) - place[:, :, None] * place[:, None, :])).sum(0)
    turning = numpy.linalg.solve(inertia, (mass * numpy.cross(place, speed)).sum(0))
    rest = speed - numpy.cross(turning, place)
    scene = (run / "scene.toml").read_text()
    frequency = float(re.search(r"^orbital_frequency = ([^ \n]+)", scene, re.M).group(1))
    return math.sqrt((mass * rest**2).sum() / mass.sum()) / frequency


def lost_rate(run):
    """J an orbit, over the last tenth of an orbit."""
    read = list(csv.DictReader((run / "series.csv").read_text().splitlines()))
    end = read[-1]
    begin = min(read, key=lambda r: abs(float(r["time_orbits"]) - float(end["time_orbits"]) + 0.1))
    return (float(end["energy_lost_j"]) - float(begin["energy_lost_j"])) / (
        float(end["time_orbits"]) - float(begin["time_orbits"]))


def pile():
    body = []
    for row in sorted(rows("pile"), key=lambda r: (r["collisions.restitution"], int(r["gravity.kick_every"]), r["carried"])):
        run = RUNS / "pile" / "runs" / row["run"]
        law = row["collisions.restitution"]
        words = "0.5" if "constant" in law else "Bridges 0.34" + (", at most 0.9" if "max_coefficient" in law else "")
        body.append([words, f"{int(row['gravity.kick_every'])}e-3", "carried" if row["carried"] else "bounced",
                     f"{lost_rate(run):.3f}", f"{random_speed(run):.3f}", number(row["collisions_per_particle_orbit"], 2),
                     number(row["overlap"], 2), number(row["cost"])])
    return table(["restitution", "kick interval, orbits", "contacts at rest", "lost, J an orbit", "random speed, rΩ",
                  "contacts a particle and orbit", "overlap", "processor µs a particle and step"], body)


def figure():
    pyplot.switch_backend("svg")
    matplotlib.rcParams["svg.hashsalt"] = "keeler"
    drawn, axes = pyplot.subplots(1, 2, figsize=(9, 4), layout="constrained")
    colours = {1.0: "#1b6ca8", 2.0: "#c1662f", 3.0: "#5a8f3c"}
    for column, axis, name in (("energy_balance", axes[0], "energy lost / work of the shear"),
                               ("cost", axes[1], "processor µs a particle and step")):
        for depth, colour in colours.items():
            for carried, style in ((True, "o-"), (False, "s--")):
                points = sorted((HILL[density(r)], float(r[column])) for r in rows("states")
                                if float(r["particles.optical_depth"]) == depth and r["carried"] == carried and r[column])
                axis.plot(*zip(*points), style, color=colour, markersize=4, linewidth=1,
                          label=f"τ = {depth:.0f}, {'carried' if carried else 'bounced'}")
        axis.set_xlabel("r_h")
        axis.set_ylabel(name)
    axes[0].axhspan(0.97, 1.03, color="#dddddd", zorder=0)
    axes[0].legend(fontsize=8)
    axes[1].set_yscale("log")
    drawn.savefig(FIGURE, metadata={"Date": None})


def main():
    more = sys.argv[1:]
    if more not in ([], ["--tables"]):
        sys.exit("usage: scripts/hard-spheres [--tables]")
    for grid in ("states", "wakes", "kicks", "dense", "cuts", "pile"):
        sweep(grid, more)
    text = PAGE.read_text()
    for name, made in (("states", states), ("wakes", wakes), ("kicks", kicks), ("dense", dense), ("cuts", cuts), ("pile", pile)):
        text, count = re.subn(rf"(<!--made:hard-spheres.{name}-->\n).*?(<!--/-->)", lambda m: m[1] + made() + m[2], text, flags=re.S)
        if count != 1:
            sys.exit(f"{PAGE}: the marks of the table '{name}' are not there once")
    PAGE.write_text(text)
    figure()
    print(f"{PAGE.relative_to(SOURCE)} and {FIGURE.relative_to(SOURCE)} are written")


if __name__ == "__main__":
    main()
