"""Particles to and from REBOUND, by stand-ins for its simulations (stand_in.py)."""

import math
import unittest
import warnings

import numpy as np

import keeler
from scenes import ring
from stand_in import Rebound4, Rebound5

OMEGA = 0.00013143527
G = 6.67428e-11
PLANET = {"orbital_frequency": OMEGA}
PARTICLES = [
    {"m": 1.5e4, "r": 1.0, "x": -20.0, "y": 3.0, "z": 0.5, "vx": 1e-4, "vy": 1.5 * OMEGA * 20.0, "vz": -2e-4},
    {"m": 5.0e4, "r": 1.5, "x": 10.0, "y": -40.0, "z": -0.25, "vx": 0.0, "vy": -1.5 * OMEGA * 10.0 + 1e-4, "vz": 0.0},
    {"m": 1.5e4, "r": 1.0, "x": 45.0, "y": 47.0, "z": 0.0, "vx": -1e-4, "vy": -1.5 * OMEGA * 45.0, "vz": 1e-4},
]


def bridges(sim, speed):
    """REBOUND's example of Saturn's rings, in m/s."""
    return min(1.0, 0.32 * abs(100.0 * speed) ** -0.234) if speed else 1.0


def sheet(kind, length=1.0, mass=1.0, time=1.0):
    """PARTICLES in a box of 100 m, in units of these in SI."""
    sim = kind()
    owner = sim if kind is Rebound5 else sim.ri_sei
    owner.OMEGA = OMEGA * time
    sim.G = G * mass * time**2 / length**3
    sim.dt = 1e-3 * 2.0 * np.pi / OMEGA / time
    if kind is Rebound5:
        sim.root_size = 100.0 / length
    else:
        sim.configure_box(100.0 / length)
    sim.integrator, sim.boundary, sim.gravity, sim.collision = "sei", "shear", "tree", "tree"
    sim.N_ghost_x, sim.N_ghost_y = 2, 2
    units = {"m": mass, "r": length, **dict.fromkeys("xyz", length), **dict.fromkeys(("vx", "vy", "vz"), length / time)}
    for row in PARTICLES:
        sim.add(**{name: value / units[name] for name, value in row.items()})
    return sim


def taken(sim, *values, **named):
    """from_rebound without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return keeler.from_rebound(sim, *values, **named)


def column(*names):
    return np.array([[row[name] for name in names] for row in PARTICLES])


class FromRebound(unittest.TestCase):
    def assert_particles(self, sim, digits=0.0):
        """Velocities pass through m per radian: two roundings."""
        for found, exact, spread in (
            (sim.by_id(sim.positions), column("x", "y", "z"), 1e-13),
            (sim.by_id(sim.velocities), column("vx", "vy", "vz"), 1e-15),
            (sim.by_id(sim.radii), column("r")[:, 0], digits * 2.0),
            (sim.by_id(sim.masses), column("m")[:, 0], digits * 1e5),
        ):
            np.testing.assert_allclose(found, exact, rtol=0.0, atol=spread)

    def assert_fails(self, pattern, sim, **named):
        with self.assertRaisesRegex(keeler.UsageError, pattern) as raised:
            taken(sim, **named)
        self.assertNotIn("\n", str(raised.exception))

    def test_either_version_gives_its_particles(self):
        for kind in (Rebound4, Rebound5):
            sim = taken(sheet(kind))
            self.assert_particles(sim)
            self.assertEqual(sim.box, (100.0, 100.0))
            self.assertEqual(sim.orbital_frequency, OMEGA)
            for line in ("step = 0.001", "vertical_ratio = 1.0", "value = 1.0", "[gravity]"):
                self.assertIn(line, sim.scene)
            self.assertEqual(len(sim.run(0.01)), 3)

    def test_several_root_boxes_are_one_box(self):
        other = sheet(Rebound4)
        other.configure_box(100.0, 1, 2)
        self.assertEqual(taken(other).box, (100.0, 200.0))
        other = sheet(Rebound5)
        other.N_root_x = 3
        self.assertEqual(taken(other).box, (300.0, 100.0))

    def test_the_shear_offset_is_that_of_its_time(self):
        other = sheet(Rebound4)
        other.t = 0.3 * 2.0 * np.pi / OMEGA
        offset = 1.5 * OMEGA * 100.0 * other.t
        self.assertGreater(offset, 200.0)
        self.assertAlmostEqual(taken(other).shear_offset, offset % 100.0, places=9)
        other.t = -other.t
        self.assertAlmostEqual(taken(other).shear_offset, 100.0 - offset % 100.0, places=9)

    def test_neighbours_across_the_box_are_those_of_its_ghost_boxes(self):
        """A particle in REBOUND's ghost box (1, 0) is at x + L, y - (1.5 Omega L t mod L)."""
        other = Rebound4()
        other.ri_sei.OMEGA, other.G, other.dt, other.t = OMEGA, G, 10.0, 5000.0
        other.configure_box(100.0)
        other.integrator, other.boundary, other.gravity, other.collision = "sei", "shear", "none", "tree"
        shift = (1.5 * OMEGA * 100.0 * other.t) % 100.0
        for x, y, on in ((-49.5, 0.0, 0.0), (49.5, -shift, 0.5)):  # 1 m apart, and the second above by 0.5
            other.add(m=1.0, r=1.0, x=x, y=y if y >= -50 else y + 100.0, z=on, vy=-1.5 * OMEGA * x)
        with self.assertRaises(keeler.InvariantError):
            taken(other)
        sim = taken(other, relax=True)
        (x0, y0, z0), (x1, y1, z1) = sim.by_id(sim.positions)
        along = (y1 - y0 + sim.shear_offset + 50.0) % 100.0 - 50.0
        self.assertTrue(2.0 <= math.dist((0, 0, 0), (x0 + 100.0 - x1, along, z1 - z0)) < 2.3)  # apart by a margin

    def test_units_other_than_si(self):
        for length, mass, time in ((1e3, 1.0, 1.0), (1e-2, 1e-3, 1.0), (1.0, 1.5e4, 1.0 / OMEGA)):
            other = sheet(Rebound5, length, mass, time)
            self.assert_fails("its units are not SI.*units=", other)
            for missing in ("length", "mass", "time"):
                units = {"length": length, "mass": mass, "time": time}
                del units[missing]
                sim = taken(other, units=units)
                # G is published with an error of 1e-5
                np.testing.assert_allclose(sim.by_id(sim.positions), column("x", "y", "z"), rtol=1e-5, atol=1e-12)
                np.testing.assert_allclose(sim.by_id(sim.masses), column("m")[:, 0], rtol=1e-5)
                np.testing.assert_allclose(sim.orbital_frequency, OMEGA, rtol=1e-5)
                self.assertAlmostEqual(taken(other, units=units).box[0], 100.0, places=2)
            self.assert_fails("which is not 6.6743e-11", other, units={"length": length, "mass": 2.0 * mass, "time": time})
        self.assert_fails("name two of them", other, units={"length": 1.0})
        self.assert_fails("name two of them", other, units={"length": 1.0, "time": -1.0})
        self.assert_fails("name two of them", other, units="SI")
        other.gravity = "none"
        self.assert_fails("name both", other, units={"length": length, "mass": mass})
        sim = taken(other, units={"length": length, "time": time, "mass": mass})
        np.testing.assert_allclose(sim.by_id(sim.masses), column("m")[:, 0], rtol=1e-15)

    def test_published_values_of_g_are_si(self):
        for value in (6.67e-11, 6.672e-11, 6.67259e-11, 6.67384e-11, 6.6743e-11):
            other = sheet(Rebound4)
            other.G = value
            self.assert_particles(taken(other))
        other.G = 6.5e-11
        self.assert_fails("not SI", other)

    def test_a_vertical_frequency(self):
        other = sheet(Rebound4)
        other.ri_sei.OMEGAZ = 3.6 * OMEGA
        self.assertIn("vertical_ratio = 3.6", taken(other).scene)

    def test_gravity_and_contacts(self):
        other = sheet(Rebound4)
        other.gravity = "none"
        self.assertNotIn("[gravity]", taken(other).scene)
        sim = taken(sheet(Rebound4), gravity={"solver": "tree", "images": "rings", "image_rings": 2}, time={"end": 3.0})
        for line in ('images = "rings"', "image_rings = 2", "end = 3.0"):
            self.assertIn(line, sim.scene)

    def test_restitution(self):
        other = sheet(Rebound4)
        self.assertIn('law = "constant"', taken(other).scene)
        other.coefficient_of_restitution = bridges
        self.assert_fails("cannot be read back", other)
        self.assertIn("scale = 0.32", taken(other, collisions={"restitution": {"law": "bridges", "scale": 0.32}}).scene)
        scene = {"collisions": {"restitution": {"law": "constant", "value": 0.5}}, "time": {"end": 2.0}}
        self.assertIn("value = 0.5", taken(other, scene).scene)
        self.assert_fails("cannot be called as", other, restitution=lambda speed: 1.0)
        self.assert_fails("between 0 and 1", other, restitution=lambda sim, speed: 2.0)

    def test_a_function_of_restitution_is_tabulated(self):
        """Two spheres that meet head-on bounce by the function; linear in log v between 20 rows in a decade, the table is
        within (ln 10/20)^2/8 v^2 e'' = 1.7e-3 x 0.289 of e."""
        speed = 2e-3
        for time in (1.0, 1.0 / OMEGA):
            other = Rebound5()
            other.OMEGA, other.G, other.dt, other.root_size = OMEGA * time, 1.0, 6.0 / time, 100.0
            other.integrator, other.boundary, other.gravity, other.collision = "sei", "shear", "none", "direct"
            for x in (-1.01, 1.01):
                other.add(m=1.0, r=1.0, x=0.0, y=0.0, z=x, vz=-math.copysign(0.5 * speed, x) * time)
            law = lambda sim, v: bridges(sim, v / time)
            other.coefficient_of_restitution = law
            sim = taken(other, restitution=law, units={"length": 1.0, "time": time})
            with sim.collisions() as contacts:
                sim.run(0.1)
                (contact,) = contacts()[:1]
            lost = contact["energy_lost_j"] / (0.25 * contact["normal_speed_m_s"] ** 2)
            self.assertAlmostEqual(math.sqrt(1.0 - lost), bridges(None, contact["normal_speed_m_s"]), delta=5e-4)

    def test_what_is_left_out_is_said(self):
        other = sheet(Rebound4)
        other.softening, other.minimum_collision_velocity = 0.2, 1e-7
        other._collision_resolve = type(other._collision_resolve)(lambda sim: None)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            keeler.from_rebound(other)
        text = "\n".join(str(warning.message) for warning in caught)
        for said in ("softening (0.2 m)", "2 x 2 rings", '"image_rings": 2', "minimum_collision_velocity (1e-07 m/s)", "collision_resolve"):
            self.assertIn(said, text)
        self.assertEqual({warning.filename for warning in caught}, {__file__})

    def test_other_physics_is_refused(self):
        def refused(pattern, **changed):
            other = sheet(Rebound4)
            for name, value in changed.items():
                setattr(other, name, value)
            self.assert_fails(pattern, other)

        refused('integrator is "whfast".*"sei"', integrator="whfast")
        refused('boundary is "periodic".*"shear"', boundary="periodic")
        refused("all spheres collide", collision="none")
        refused("variational", N_var=1)
        refused("test particles", N_active=2)
        refused("additional_forces", additional_forces=lambda sim: None)
        refused("forward only", dt=-1.0)
        refused("no box", root_size=-1.0, boxsize=type(Rebound4().boxsize)())
        other = sheet(Rebound4)
        other.ri_sei.Q_NL = 0.1
        self.assert_fails("eccentric", other)
        other = sheet(Rebound4)
        other.N = 0
        self.assert_fails("no particles", other)
        self.assert_fails("no simulation of REBOUND", object())
        other = sheet(Rebound4)
        other.add(m=1.0, r=0.0, x=0.0, y=0.0, z=0.0)
        self.assert_fails("row 3.*radius", other)


class ToRebound(unittest.TestCase):
    def test_a_round_trip_is_equal(self):
        scene = ring(planet=PLANET, gravity={"solver": "direct"})
        sim = keeler.Simulation(scene).run(0.13)
        for kind in (Rebound4, Rebound5):
            other = kind()
            particles = keeler.to_rebound(sim, other)
            other.dt, other.gravity, other.collision = 10.0, "tree", "tree"
            self.assertEqual(other.N, len(sim))
            again = taken(other, collisions=scene["collisions"])
            self.assertAlmostEqual(again.shear_offset, sim.shear_offset, places=12)
            inside = np.all(np.abs(sim.by_id(sim.positions)[:, :2]) <= 30.0, axis=1)
            self.assertGreater(inside.mean(), 0.9)
            self.assertFalse(inside.all())  # some are images
            np.testing.assert_allclose(again.by_id(again.positions)[inside], sim.by_id(sim.positions)[inside], rtol=0, atol=3e-14)
            np.testing.assert_allclose(again.by_id(again.velocities)[inside], sim.by_id(sim.velocities)[inside], rtol=0, atol=3e-17)
            self.assertTrue(np.array_equal(again.by_id(again.masses), sim.by_id(sim.masses)))
            self.assertTrue(np.array_equal(again.by_id(again.radii), sim.by_id(sim.radii)))
            beyond = lambda s: s.by_id(s.velocities) + 1.5 * s.orbital_frequency * s.by_id(s.positions)[:, [0]] * [0, 1, 0]
            np.testing.assert_allclose(beyond(again), beyond(sim), rtol=0, atol=1e-15)
            self.assertEqual(sorted(particles), ["m", "r", "vx", "vy", "vz", "x", "y", "z"])
            self.assertTrue(np.array_equal(particles["z"], sim.by_id(sim.positions)[:, 2]))

    def test_images_have_the_same_neighbours(self):
        """The image that replaces a particle outside the box is one of its lattice, by the distance to a fixed point."""
        sim = keeler.Simulation(ring(planet=PLANET)).run(0.13)
        particles = keeler.to_rebound(sim)
        (size_x, size_y), offset = sim.box, sim.shear_offset
        step = np.column_stack([particles[name] for name in "xyz"]) - sim.by_id(sim.positions)
        across = np.rint(step[:, 0] / size_x)
        np.testing.assert_allclose(step[:, 0], across * size_x, atol=1e-12)
        along = (step[:, 1] + across * offset) / size_y
        np.testing.assert_allclose(along, np.rint(along), atol=1e-12)
        self.assertTrue(np.any(across != 0))

    def test_an_oblong_box(self):
        sim = keeler.Simulation(ring(planet=PLANET, box={"size": [30.0, 60.0]}))
        other = Rebound4()
        keeler.to_rebound(sim.snapshot(), other)
        self.assertEqual((other.root_size, other.N_root_x, other.N_root_y), (30.0, 1, 2))
        self.assertEqual((other.integrator, other.boundary, other.ri_sei.OMEGA), ("sei", "shear", sim.orbital_frequency))
        sim = keeler.Simulation(ring(planet=PLANET, box={"size": [40.0, 50.0]}))
        with self.assertRaisesRegex(keeler.UsageError, "whole multiples"):
            keeler.to_rebound(sim, Rebound4())
        self.assertEqual(len(keeler.to_rebound(sim)["m"]), len(sim))

    def test_what_rebound_lacks(self):
        rough = keeler.Simulation(ring(planet=PLANET, collisions={"friction": {"tangential_restitution": 0.5}}))
        with self.assertWarnsRegex(UserWarning, "no spins"):
            keeler.to_rebound(rough)
        tilted = keeler.Simulation(ring(planet={"orbital_frequency": 1e-4, "epicyclic_ratio": 0.9}))
        with self.assertRaisesRegex(keeler.UsageError, "kappa is 0.9 Omega"):
            keeler.to_rebound(tilted, Rebound4())
        with self.assertWarnsRegex(UserWarning, "a shear of 1.595 Omega"):
            particles = keeler.to_rebound(tilted)
        self.assertLess(np.abs(particles["vy"] + 1.595e-4 * particles["x"]).max(), 0.01)
        with self.assertRaisesRegex(keeler.UsageError, "3 particles already"):
            keeler.to_rebound(keeler.Simulation(ring(planet=PLANET)), sheet(Rebound4))


if __name__ == "__main__":
    unittest.main()
