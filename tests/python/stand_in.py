"""Stand-ins for rebound.Simulation of REBOUND 4 and 5, with the attributes and methods that Keeler uses, named and typed
as in rebound/simulation.py. The package itself is not used by the tests."""

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_double, c_int, c_uint

import numpy as np

INTEGRATORS = {"ias15": 0, "whfast": 1, "sei": 2, "leapfrog": 4}
BOUNDARIES = {"none": 0, "open": 1, "periodic": 2, "shear": 3}
GRAVITIES = {"none": 0, "basic": 1, "compensated": 2, "tree": 3}
COLLISIONS = {"none": 0, "direct": 1, "tree": 2, "line": 4, "linetree": 5}
FUNCTIONS = ("additional_forces", "pre_timestep_modifications", "post_timestep_modifications", "collision_resolve")


class Vec3dBasic(ctypes.Structure):
    _fields_ = [("x", c_double), ("y", c_double), ("z", c_double)]


class IntegratorSEI(ctypes.Structure):
    _fields_ = [("OMEGA", c_double), ("OMEGAZ", c_double), ("Q_NL", c_double)]


def _choice(name, values):
    def read(self):
        return next(word for word, number in values.items() if number == getattr(self, "_" + name))

    def write(self, word):
        setattr(self, "_" + name, values[word.lower()])

    return property(read, write)


def _function(name, kind):
    def read(self):
        raise AttributeError("You can only set C function pointers from python.")

    def write(self, function):
        setattr(self, "_kept_" + name, kind(function))  # as REBOUND does, to keep it alive
        setattr(self, "_" + name, getattr(self, "_kept_" + name))

    return property(read, write)


_Force = CFUNCTYPE(None, ctypes.c_void_p)
_Restitution = CFUNCTYPE(c_double, ctypes.c_void_p, c_double)
_SHARED = [
    ("t", c_double), ("G", c_double), ("softening", c_double), ("dt", c_double), ("N", c_uint), ("N_var", c_int),
    ("N_active", c_int), ("opening_angle2", c_double), ("root_size", c_double), ("N_root_x", c_int), ("N_root_y", c_int),
    ("N_root_z", c_int), ("N_ghost_x", c_int), ("N_ghost_y", c_int), ("N_ghost_z", c_int),
    ("minimum_collision_velocity", c_double), ("_collision", c_int), ("_integrator", c_int), ("_boundary", c_int),
    ("_gravity", c_int), ("_coefficient_of_restitution", _Restitution), *(("_" + name, _Force) for name in FUNCTIONS),
]  # fmt: skip


class _Base(ctypes.Structure):
    integrator, boundary = _choice("integrator", INTEGRATORS), _choice("boundary", BOUNDARIES)
    gravity, collision = _choice("gravity", GRAVITIES), _choice("collision", COLLISIONS)
    coefficient_of_restitution = _function("coefficient_of_restitution", _Restitution)
    additional_forces = _function("additional_forces", _Force)

    @property
    def collision_resolve(self):
        raise AttributeError("You can only set C function pointers from python.")

    @collision_resolve.setter
    def collision_resolve(self, function):
        if function in ("hardsphere", "merge", "halt"):  # functions of REBOUND's library
            function = lambda sim: None
        self._kept_collision_resolve = self._collision_resolve = _Force(function)

    def __init__(self):
        super().__init__(G=1.0, dt=0.001, N_active=-1, root_size=-1.0, N_root_x=1, N_root_y=1, N_root_z=1, _gravity=1)
        self.rows = []

    def add(self, particle=None, **row):
        if particle is not None or not set(row) <= {"m", "r", "x", "y", "z", "vx", "vy", "vz"}:
            raise ValueError("Argument passed to add() not supported.")
        half = [0.5 * self.root_size * n for n in (self.N_root_x, self.N_root_y)]
        if self.root_size > 0 and not all(abs(row.get(axis, 0.0)) <= side for axis, side in zip("xy", half)):
            raise RuntimeError("Particle outside of box boundaries. Did not add particle.")
        self.rows.append(row)
        self.N += 1

    def serialize_particle_data(self, **arrays):
        columns = {"m": ("m",), "r": ("r",), "xyz": ("x", "y", "z"), "vxvyvz": ("vx", "vy", "vz")}
        for name, array in arrays.items():
            if name not in columns:
                raise AttributeError("not supported for serialization")
            if array.dtype != "float64" or array.size < len(columns[name]) * self.N:
                raise AttributeError(f"Array '{name}' is not large enough.")
            flat = np.array([row.get(column, 0.0) for row in self.rows for column in columns[name]])
            ctypes.memmove(array.ctypes.data, flat.ctypes.data, flat.nbytes)  # the memory, whatever its shape


class Rebound4(_Base):
    _fields_ = [*_SHARED, ("boxsize", Vec3dBasic), ("ri_sei", IntegratorSEI)]

    def __init__(self):
        super().__init__()
        self.ri_sei.OMEGA, self.ri_sei.OMEGAZ = 1.0, -1.0

    def configure_box(self, boxsize, N_root_x=1, N_root_y=1, N_root_z=1):
        self.root_size, self.N_root_x, self.N_root_y, self.N_root_z = boxsize, N_root_x, N_root_y, N_root_z
        self.boxsize = Vec3dBasic(boxsize * N_root_x, boxsize * N_root_y, boxsize * N_root_z)


class Rebound5(_Base):
    _fields_ = [*_SHARED, ("OMEGA", c_double), ("OMEGAZ", c_double)]

    def __init__(self):
        super().__init__()
        self.OMEGA, self.OMEGAZ = 1.0, -1.0
