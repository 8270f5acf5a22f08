"""Simulations of REBOUND, by duck typing: the package ``rebound`` is never imported."""

import ctypes
import math

import numpy as np

from . import _arguments, scenes, simulation, snapshots
from .errors import UsageError

_G = 6.6743e-11  # m^3/(kg s^2), CODATA 2018
_G_SPREAD = 1e-3  # published values of G, from 6.67e-11 to 6.6743e-11
_SPEEDS = np.geomspace(1e-7, 1e2, 181)  # m/s, 20 in a decade


def from_rebound(sim, scene=None, *, units=None, restitution=None, relax=False, **overrides):
    """Returns a Simulation of the particles in a ``rebound.Simulation`` of the shearing sheet (REBOUND 4 or 5).

    Taken from ``sim``: positions, velocities, radii, masses (particle k gets the id k), OMEGA, OMEGAZ, the box, the
    shear offset of its time, dt, and whether there is self-gravity. ``scene`` and ``overrides`` give everything else,
    as in Simulation(); overrides also replace what was taken. ``relax`` moves overlapping particles apart, which
    REBOUND allows and Keeler does not.

    ``units`` are those of ``sim``. Without it G must be that of SI. Otherwise name two of them, in SI:
    ``{"length": 1e3, "time": 1.0}`` (m, s, kg); the third follows from G. Without gravity G says nothing: name length
    and time, and mass (default 1 kg).

    ``restitution`` is the function that ``sim.coefficient_of_restitution`` was given, which cannot be read back: it is
    tabulated, as ``restitution(sim, speed)``. Without it, a sim that has such a function needs
    ``collisions.restitution`` in the scene or the overrides; one that has none bounces elastically, as in REBOUND.

    Warns (UserWarning) of what Keeler does not take over: softening, ghost boxes, minimum_collision_velocity, a rule
    for contacts. Raises UsageError for other physics: another integrator or boundary, no contacts, forces of your own,
    test particles, variational equations.
    """
    _require_sheet(sim)
    length, mass, time = _units(sim, units)
    frequency = _frequency(sim) / time
    box = [side * length for side in _box(sim)]
    given = {
        "planet.orbital_frequency": frequency,
        "box.size": box,
        "time.step": _number(sim, "dt") * time * frequency / (2.0 * math.pi),
        "time.end": 1.0,
    }
    if given["time.step"] <= 0.0:
        raise UsageError(f"sim.dt is {sim.dt:g}, and Keeler runs forward only; set a positive one")
    ratio = _vertical_ratio(sim)
    if ratio != 1.0:
        given["planet.vertical_ratio"] = ratio
    if sim.gravity != "none":
        given["gravity"] = {}
    if restitution is not None:
        given["collisions.restitution"] = {"law": "table", "table": _tabulated(sim, restitution, length / time)}
    own = dict(_flat(overrides, ""))
    text = scenes.source(scene)[0] if scene is not None else ""
    if restitution is None and not _names_restitution(text, own):
        if _is_set(sim, "_coefficient_of_restitution") is not False:
            raise UsageError(
                "sim may have a coefficient_of_restitution, a function that cannot be read back; give it again as "
                'restitution=, or name a law: collisions={"restitution": {"law": "bridges", "scale": 0.32}}'
            )
        given["collisions.restitution"] = {"law": "constant", "value": 1.0}
    if scene is not None:
        given.pop("time.end")
    snapshots.warn(_left_out(sim, length, time))
    count = _count(sim)
    positions, velocities, radii, masses = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    sim.serialize_particle_data(xyz=positions, vxvyvz=velocities, r=radii, m=masses)
    offset = (1.5 * _frequency(sim) * _box(sim)[0] * _number(sim, "t")) % _box(sim)[1] * length
    return simulation.from_arrays(
        {} if scene is None else scene,
        positions * length,
        radii * length,
        velocities * (length / time),
        masses * mass,
        relax=relax,
        shear_offset=offset if offset < box[1] else 0.0,
        **{key: value for key, value in given.items() if not _is_replaced(key, own)},
        **own,
    )


def to_rebound(state, rebound_simulation=None):
    """Returns the particles of a Simulation or a Snapshot as REBOUND takes them, in SI and in the order of their ids:
    a dictionary of arrays m, r, x, y, z, vx, vy, vz, so that ``sim.add(**{name: array[k] ...})`` adds particle k.

    Particles outside the box, which Keeler has where the guiding centre is inside, are replaced by their image in it;
    all other numbers are equal to the bit. An empty ``rebound_simulation`` is filled: OMEGA, OMEGAZ, G, the box, the
    time (so that the ghost boxes have the shear offset), integrator "sei", boundary "shear", and the particles. Set
    dt, gravity, contacts and restitution yourself.

    Warns (UserWarning) of spins, which REBOUND lacks, and of a kappa that is not Omega, as the presets have it; with
    ``rebound_simulation`` the latter is a UsageError.
    """
    snapshot = snapshots.as_snapshot(state)
    kappa, nu = snapshot._core.frequency_ratios
    if kappa != 1.0:
        fault = f"kappa is {kappa:g} Omega here, and in REBOUND's shearing sheet kappa is Omega"
        if rebound_simulation is not None:
            raise UsageError(f"{fault}; give planet.orbital_frequency instead of a preset, or call to_rebound without a simulation")
        snapshots.warn([f"{fault}: the velocities have a shear of {_shear(snapshot) / snapshot.orbital_frequency:g} Omega, not 1.5"])
    if snapshot.spins is not None:
        snapshots.warn(["REBOUND has no spins; those of the particles are left out"])
    particles = _in_the_box(snapshot)
    if rebound_simulation is not None:
        _fill(rebound_simulation, snapshot, nu, particles)
    return particles


def _shear(snapshot):
    kappa, _ = snapshot._core.frequency_ratios
    return 0.5 * (4.0 - kappa**2) * snapshot.orbital_frequency


def _in_the_box(snapshot):
    (size_x, size_y), offset = snapshot.box, snapshot.shear_offset
    x, y, z = snapshot.positions.T.copy()
    vx, vy, vz = snapshot.velocities.T.copy()
    while True:
        turns = np.where(np.abs(x) > 0.5 * size_x, np.rint(x / size_x), 0.0)
        if not turns.any():
            break
        x -= turns * size_x
        y += turns * offset
        vy += turns * _shear(snapshot) * size_x
    y -= np.where(np.abs(y) > 0.5 * size_y, np.rint(y / size_y), 0.0) * size_y
    m, r = np.array(snapshot.masses), np.array(snapshot.radii)
    return {"m": m, "r": r, "x": x, "y": y, "z": z, "vx": vx, "vy": vy, "vz": vz}


def _fill(sim, snapshot, vertical_ratio, particles):
    if sim.N:
        raise UsageError(f"the REBOUND simulation has {sim.N} particles already; give an empty one")
    (size_x, size_y), frequency = snapshot.box, snapshot.orbital_frequency
    root = min(size_x, size_y)
    roots = [round(size / root) for size in snapshot.box]
    if any(not math.isclose(n * root, size, rel_tol=1e-12) for n, size in zip(roots, snapshot.box)):
        raise UsageError(
            f"the box is {size_x:g} m x {size_y:g} m, and REBOUND's has sides that are whole multiples of the shorter one; "
            "call to_rebound without a simulation, and use the arrays"
        )
    owner = sim.ri_sei if hasattr(getattr(sim, "ri_sei", None), "OMEGA") else sim
    owner.OMEGA, owner.OMEGAZ = frequency, vertical_ratio * frequency
    sim.G = _G
    sim.integrator, sim.boundary = "sei", "shear"
    if hasattr(sim, "configure_box"):
        sim.configure_box(root, *roots, 1)
    else:
        sim.root_size, sim.N_root_x, sim.N_root_y, sim.N_root_z = root, *roots, 1
    sim.t = snapshot.shear_offset / (1.5 * frequency * size_x)
    rows = zip(*(array.tolist() for array in particles.values()))
    for row in rows:
        sim.add(**dict(zip(particles, row)))


def _require_sheet(sim):
    """Raises UsageError unless the simulation has the physics that Keeler has."""
    try:
        wanted = (("integrator", "sei"), ("boundary", "shear"))
        found = [(name, str(getattr(sim, name)).lower(), value) for name, value in wanted]
        _count(sim), sim.serialize_particle_data, sim.gravity, sim.collision
    except AttributeError as error:
        raise UsageError(f"{_arguments.shown(sim)} is no simulation of REBOUND 4 or 5 ({error}); give a rebound.Simulation") from None
    for name, value, needed in found:
        if value != needed:
            raise UsageError(f'sim.{name} is "{value}", and Keeler has the shearing sheet only; set it to "{needed}" where that is meant')
    if _count(sim) == 0:
        raise UsageError("sim has no particles; add them first")
    if sim.collision == "none":
        raise UsageError("sim.collision is \"none\", and in Keeler all spheres collide; choose one of REBOUND's where that is meant")
    if getattr(sim, "N_var", 0):
        raise UsageError("sim has variational equations, which Keeler lacks; give one without them")
    active = getattr(sim, "N_active", -1)
    if sim.gravity != "none" and 0 <= active < _count(sim):
        raise UsageError(f"sim has test particles (N_active is {active} of {_count(sim)}), and in Keeler all attract; set N_active = -1")
    for name in ("additional_forces", "pre_timestep_modifications", "post_timestep_modifications"):
        if _is_set(sim, "_" + name):
            raise UsageError(f"sim.{name} is a function, and Keeler cannot call it; give a simulation without it")
    if getattr(getattr(sim, "ri_sei", None), "Q_NL", 0.0):
        raise UsageError("sim.ri_sei.Q_NL is an eccentric shearing sheet, which Keeler lacks; set it to 0")


def _is_set(sim, name):
    """Returns whether a function pointer is set; None where the simulation does not tell."""
    pointer = getattr(sim, name, None)
    return None if pointer is None else bool(pointer)


def _number(sim, name):
    value = float(getattr(sim, name))
    if not math.isfinite(value):
        raise UsageError(f"sim.{name} is {value}; set a finite number")
    return value


def _count(sim):
    return int(sim.N) - int(getattr(sim, "N_var", 0))


def _frequency(sim):
    owner = sim.ri_sei if hasattr(getattr(sim, "ri_sei", None), "OMEGA") else sim
    frequency = _number(owner, "OMEGA")
    if frequency <= 0.0:
        raise UsageError(f"OMEGA is {frequency:g}; set the orbital frequency of the sheet")
    return frequency


def _vertical_ratio(sim):
    owner = sim.ri_sei if hasattr(getattr(sim, "ri_sei", None), "OMEGA") else sim
    vertical = float(getattr(owner, "OMEGAZ", -1.0))
    return 1.0 if vertical == -1.0 else vertical / _frequency(sim)  # -1: as OMEGA


def _box(sim):
    root = float(getattr(sim, "root_size", -1.0))
    sides = [root * int(getattr(sim, f"N_root_{axis}", 1)) for axis in "xy"]
    if root <= 0.0:
        sides = [float(getattr(getattr(sim, "boxsize", None), axis, 0.0)) for axis in "xy"]
    if not min(sides) > 0.0:
        raise UsageError("sim has no box; configure it first (configure_box, or root_size)")
    return sides


def _units(sim, units):
    """Returns the units of length, mass and time in m, kg and s."""
    gravity = sim.gravity != "none"
    if units is None:
        if abs(sim.G / _G - 1.0) <= _G_SPREAD:
            return 1.0, 1.0, 1.0
        raise UsageError(
            f"sim.G is {sim.G:g}, so its units are not SI (G = {_G:g}); name two of them, or without gravity length and "
            'time: units={"length": METRES, "time": SECONDS}'
        )
    named = dict(units) if isinstance(units, dict) else {}
    good = all(isinstance(u, (int, float)) and 0.0 < u < math.inf for u in named.values())
    if not good or not set(named) <= {"length", "mass", "time"} or len(named) < 2:
        raise UsageError(f'units is {_arguments.shown(units)}; name two of them in SI: {{"length": METRES, "time": SECONDS, "mass": KILOGRAMS}}')
    if not gravity:
        named.setdefault("mass", 1.0)
        if len(named) < 3:
            raise UsageError("units lacks length or time, and without gravity G does not give it; name both")
        return named["length"], named["mass"], named["time"]
    length, mass, time = (named.get(name) for name in ("length", "mass", "time"))
    # G in SI is sim.G length^3/(mass time^2)
    if length is None:
        length = (_G / sim.G * mass * time**2) ** (1.0 / 3.0)
    elif mass is None:
        mass = sim.G / _G * length**3 / time**2
    elif time is None:
        time = math.sqrt(sim.G / _G * length**3 / mass)
    found = sim.G * length**3 / (mass * time**2)
    if abs(found / _G - 1.0) > _G_SPREAD:
        raise UsageError(f"units make sim.G {found:g} m^3/(kg s^2), which is not {_G:g}; correct one of them")
    return length, mass, time


def _tabulated(sim, law, speed):
    """Returns rows of (speed in m/s, coefficient) of a function of REBOUND."""
    try:
        rows = [[float(v), float(law(sim, float(v) / speed))] for v in _SPEEDS]
    except (TypeError, ArithmeticError, ValueError, ctypes.ArgumentError) as error:
        raise UsageError(f"restitution cannot be called as restitution(sim, speed) ({error}); give the function of REBOUND") from None
    for v, coefficient in rows:
        if not 0.0 <= coefficient <= 1.0:
            raise UsageError(f"restitution is {coefficient:g} at {v:g} m/s; give a function between 0 and 1")
    return rows


def _names_restitution(text, own):
    lines = [line.partition("#")[0] for line in text.splitlines()]
    return any("restitution" in word for word in [*lines, *own])


def _left_out(sim, length, time):
    """Returns a line on each setting of REBOUND that Keeler does not take over."""
    lines = []
    if getattr(sim, "softening", 0.0):
        lines.append(f"sim.softening ({sim.softening * length:g} m) is left out: Keeler's gravity is not softened")
    if sim.gravity != "none":
        ghosts = [int(getattr(sim, f"N_ghost_{axis}", 0)) for axis in "xy"]
        exact = (
            f'; gravity={{"solver": "tree", "images": "rings", "image_rings": {ghosts[0]}}} sums the same'
            if ghosts[0] == ghosts[1]
            else ""
        )
        lines.append(f"sim sums {ghosts[0]} x {ghosts[1]} rings of ghost boxes, and Keeler the gravity of all images{exact}")
    if getattr(sim, "minimum_collision_velocity", 0.0):
        slowest = sim.minimum_collision_velocity * length / time
        lines.append(f"sim.minimum_collision_velocity ({slowest:g} m/s) is left out: Keeler's contacts need none")
    if _is_set(sim, "_collision_resolve") is not False:
        lines.append("sim.collision_resolve cannot be read back: in Keeler all contacts are those of hard spheres")
    return lines


def _flat(tables, place):
    """Yields the keys of nested tables with their values: "time.end", 2.0."""
    for name, value in tables.items():
        if isinstance(value, dict) and value and f"{place}{name}" not in ("collisions.restitution", "gravity"):
            yield from _flat(value, f"{place}{name}.")
        else:
            yield f"{place}{name}", value


def _is_replaced(key, own):
    return any(other == key or other.startswith(key + ".") or key.startswith(other + ".") for other in own)
