// Forces that Python registers: a function of Python, called once a kick, or a compiled one, called for blocks of
// particles in several threads.
#include "arrays.hpp"
#include "bindings.hpp"
#include "own_parts.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/units.hpp>
#include <keeler/forces/force.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <memory>

namespace keeler::python {
namespace {

using forces::Boundary;

// The C type of a compiled force. Arrays have one row per particle of a block: x, y, z of vectors in m, m/s and m/s²;
// `beyond_shear` is the velocity relative to the local shear; `kick` is the time (orbits), the interval between kicks
// (s), the orbital frequency (rad/s), both sides of the box (m) and its shear offset (m); `keys` has the values of the
// force's keys in their order. It is called in several threads at once and writes all accelerations.
using CompiledForceFunction = void (*)(std::int64_t count, const double* positions, const double* velocities,
                                       const double* beyond_shear, const double* masses, const double* radii,
                                       const std::uint64_t* ids, const double* kick, const double* keys,
                                       double* accelerations);

// Memory that arrays of Python view. When one of them outlives its kick, the memory is left to it.
template<class T> class ArrayMemory {
public:
  T* sized(std::size_t count) {
    if (!values_ || values_.use_count() > 1)
      values_ = std::make_shared<std::vector<T>>();
    values_->resize(count);
    return values_->data();
  }

  // Returns the memory as an array, which can only be read unless `writable`.
  py::array array(std::vector<py::ssize_t> shape, bool writable = false) const {
    const py::capsule owner(new std::shared_ptr<std::vector<T>>(values_),
                            [](void* kept) { delete static_cast<std::shared_ptr<std::vector<T>>*>(kept); });
    py::array made(py::dtype::of<T>(), std::move(shape), values_->data(), owner);
    return writable ? made : sealed(std::move(made));
  }

private:
  std::shared_ptr<std::vector<T>> values_;
};

struct KickMemory {
  ArrayMemory<double> positions, velocities, beyond_shear, masses, radii, accelerations;
  ArrayMemory<std::uint64_t> ids;
};

// What a force of Python is given: the particles at a kick. Arrays are made when they are first asked for.
class Kick {
public:
  Kick(const Boundary& at, double omega, py::dict keys, KickMemory& memory)
      : at_(&at), omega_(omega), keys_(std::move(keys)), memory_(memory) {}

  // From now on only what was asked for is there.
  void end() { at_ = nullptr; }

  py::array positions() {
    return vectors(positions_, memory_.positions,
                   [](const Elements& el, const Frequencies& f, const Rotation& r, double) -> Vec3 {
                     return state_at(el, f, r).position;
                   });
  }
  py::array velocities() {
    return vectors(velocities_, memory_.velocities,
                   [](const Elements& el, const Frequencies& f, const Rotation& r, double omega) -> Vec3 {
                     return omega * state_at(el, f, r).velocity;
                   });
  }
  py::array beyond_shear() {
    return vectors(beyond_shear_, memory_.beyond_shear,
                   [](const Elements& el, const Frequencies& f, const Rotation& r, double omega) -> Vec3 {
                     return omega * peculiar_velocity(el, f, r);
                   });
  }
  py::array masses() { return numbers(masses_, memory_.masses, &Body::mass); }
  py::array radii() { return numbers(radii_, memory_.radii, &Body::radius); }
  py::array ids() {
    if (ids_.is_none()) {
      const std::vector<std::uint64_t>& of_state = during().particles.ids;
      std::copy(of_state.begin(), of_state.end(), memory_.ids.sized(of_state.size()));
      ids_ = memory_.ids.array({rows()});
    }
    return py::array(ids_);
  }

  std::size_t size() const { return during().particles.size(); }
  double orbits() const { return during().time / two_pi; }
  double interval() const { return during().interval / omega_; }
  double orbital_frequency() const { return omega_; }
  std::pair<double, double> box() const { return {during().box.size_x, during().box.size_y}; }
  double shear_offset() const { return during().offset; }
  const py::dict& keys() const { return keys_; }

private:
  const Boundary& during() const {
    if (!at_)
      throw UsageError("this kick is over; a force keeps arrays, or numbers, that it has asked for during its call");
    return *at_;
  }

  py::ssize_t rows() const { return static_cast<py::ssize_t>(during().particles.size()); }

  template<class Row> py::array vectors(py::object& made, ArrayMemory<double>& memory, const Row& row) {
    if (made.is_none()) {
      const Particles& particles = during().particles;
      const Frequencies f = during().frequencies;
      const Rotation r = during().rotation();
      double* const out = memory.sized(3 * particles.size());
      parallel_for(particles.size(), [&](std::size_t k) {
        particles.prefetch_after(k);
        Eigen::Map<Vec3>(out + 3 * k) = row(particles.bodies[k].elements, f, r, omega_);
      });
      made = memory.array({rows(), 3});
    }
    return py::array(made);
  }

  py::array numbers(py::object& made, ArrayMemory<double>& memory, double Body::*field) {
    if (made.is_none()) {
      const std::vector<Body>& bodies = during().particles.bodies;
      double* const out = memory.sized(bodies.size());
      parallel_for(bodies.size(), [&](std::size_t k) { out[k] = bodies[k].*field; });
      made = memory.array({rows()});
    }
    return py::array(made);
  }

  const Boundary* at_;
  double omega_;
  py::dict keys_;
  KickMemory& memory_;
  py::object positions_ = py::none(), velocities_ = py::none(), beyond_shear_ = py::none(), masses_ = py::none(),
             radii_ = py::none(), ids_ = py::none();
};

[[noreturn]] void fail_not_finite(const std::string& name, const Boundary& at, std::span<const Vec3> accelerations) {
  const auto wrong =
      std::find_if(accelerations.begin(), accelerations.end(), [](const Vec3& a) { return !a.allFinite(); });
  throw UsageError(fmt::format("the force '{}' gives the particle {} an acceleration that is not a finite number; "
                               "correct its function",
                               name, at.particles.ids[static_cast<std::size_t>(wrong - accelerations.begin())]));
}

// Takes accelerations in m/s². Throws UsageError, with the id of the particle, unless all are finite.
void take_accelerations(const std::string& name, const Boundary& at, const double* given, double omega,
                        std::span<Vec3> accelerations) {
  const double scale = 1.0 / (omega * omega);
  std::atomic<bool> finite = true;
  parallel_for(accelerations.size(), [&](std::size_t k) {
    accelerations[k] = scale * Vec3(given[3 * k], given[3 * k + 1], given[3 * k + 2]);
    if (!accelerations[k].allFinite())
      finite = false;
  });
  if (!finite)
    fail_not_finite(name, at, accelerations);
}

class PythonForce : public forces::Force {
public:
  PythonForce(std::string name, KeptObject function, std::vector<Key> keys, Parameters parameters, double omega)
      : name_(std::move(name)), function_(std::move(function)), keys_(std::move(keys)),
        parameters_(std::move(parameters)), omega_(omega) {}

  void accelerate(const Boundary& at, std::span<Vec3> accelerations) override {
    const py::gil_scoped_acquire lock;
    const std::size_t count = accelerations.size();
    double* const out = memory_.accelerations.sized(3 * count);
    std::fill_n(out, 3 * count, 0.0);
    const auto kick = std::make_shared<Kick>(at, omega_, values_of(keys_, parameters_), memory_);
    const Over at_the_end{*kick};
    const py::object returned =
        (*function_)(kick, memory_.accelerations.array({static_cast<py::ssize_t>(count), 3}, true));
    if (!returned.is_none())
      throw UsageError(fmt::format("the force '{}' returns a value, which nothing uses; write it into its second "
                                   "argument: accelerations[:] = ...",
                                   name_));
    take_accelerations(name_, at, out, omega_, accelerations);
  }

private:
  struct Over {
    Kick& kick;
    ~Over() { kick.end(); }
  };

  std::string name_;
  KeptObject function_;
  std::vector<Key> keys_;
  Parameters parameters_;
  double omega_;
  KickMemory memory_;
};

// The arrays that a compiled force reads; it is given null for the others, which are not computed.
struct ReadArrays {
  bool positions = false, velocities = false, beyond_shear = false, masses = false, radii = false;

  // Throws UsageError for a name that is none.
  explicit ReadArrays(const std::vector<std::string>& names) {
    const std::pair<const char*, bool*> all[] = {{"positions", &positions},
                                                 {"velocities", &velocities},
                                                 {"velocities_beyond_shear", &beyond_shear},
                                                 {"masses", &masses},
                                                 {"radii", &radii}};
    for (const std::string& name : names) {
      const auto found =
          std::find_if(std::begin(all), std::end(all), [&](const auto& one) { return one.first == name; });
      if (found == std::end(all))
        throw UsageError(fmt::format("'{}' is no array of a force; reads may have positions, velocities, "
                                     "velocities_beyond_shear, masses and radii",
                                     name));
      *found->second = true;
    }
  }
};

class CompiledForce : public forces::Force {
public:
  CompiledForce(std::string name, CompiledForceFunction function, const ReadArrays& reads, std::vector<double> keys,
                double omega)
      : name_(std::move(name)), function_(function), reads_(reads), keys_(std::move(keys)), omega_(omega) {}

  void accelerate(const Boundary& at, std::span<Vec3> accelerations) override {
    const double kick[] = {at.time / two_pi, at.interval / omega_, omega_, at.box.size_x, at.box.size_y, at.offset};
    const Rotation rotation = at.rotation();
    std::atomic<bool> finite = true;
    const auto one_block = [&](std::size_t number) {
      const std::size_t first = number * rows, count = std::min(rows, accelerations.size() - first);
      Block b;
      fill(b, reads_, at.particles, first, count, at.frequencies, rotation, omega_);
      const auto if_read = [](bool is_read, const double* array) { return is_read ? array : nullptr; };
      function_(static_cast<std::int64_t>(count), if_read(reads_.positions, b.positions),
                if_read(reads_.velocities, b.velocities), if_read(reads_.beyond_shear, b.beyond_shear),
                if_read(reads_.masses, b.masses), if_read(reads_.radii, b.radii), &at.particles.ids[first], kick,
                keys_.data(), b.accelerations);
      if (!take(b, accelerations.subspan(first, count), 1.0 / (omega_ * omega_)))
        finite = false;
    };
    parallel_for((accelerations.size() + rows - 1) / rows, one_block, 1);
    if (!finite)
      fail_not_finite(name_, at, accelerations);
  }

private:
  static constexpr std::size_t rows = 128; // a block of 16 kB stays in the first cache

  struct Block {
    double positions[3 * rows], velocities[3 * rows], beyond_shear[3 * rows], masses[rows], radii[rows];
    double accelerations[3 * rows];
  };

  // Gives the bits of state_at() and peculiar_velocity(). Not inlined: gcc 12 would warn of a block that is not filled.
  [[gnu::noinline]] static void fill(Block& b, const ReadArrays& reads, const Particles& particles, std::size_t first,
                                     std::size_t count, const Frequencies& f, const Rotation& r, const double omega) {
    const double half_kappa2 = 0.5 * f.kappa * f.kappa, shear = f.shear();
    const Body* const bodies = particles.bodies.data() + first;
    for (std::size_t k = 0; k < count; ++k) {
      const Body& body = bodies[k];
      __builtin_prefetch(&body + 16); // an address beyond the end is harmless
      const Elements& el = body.elements;
      const double ec = el.e_cos * r.cos_e - el.e_sin * r.sin_e, es = el.e_sin * r.cos_e + el.e_cos * r.sin_e;
      const double drift = shear * el.guiding_x, x_speed = omega * (f.kappa * es);
      const double z_speed = omega * (f.nu * (el.i_cos * r.cos_i - el.i_sin * r.sin_i));
      if (reads.positions) {
        b.positions[3 * k] = el.guiding_x - ec;
        b.positions[3 * k + 1] = el.guiding_y - drift * r.after + 2.0 / f.kappa * es;
        b.positions[3 * k + 2] = el.i_sin * r.cos_i + el.i_cos * r.sin_i;
      }
      if (reads.velocities) {
        b.velocities[3 * k] = x_speed;
        b.velocities[3 * k + 1] = omega * (2.0 * ec - drift);
        b.velocities[3 * k + 2] = z_speed;
      }
      if (reads.beyond_shear) {
        b.beyond_shear[3 * k] = x_speed;
        b.beyond_shear[3 * k + 1] = omega * (half_kappa2 * ec);
        b.beyond_shear[3 * k + 2] = z_speed;
      }
      if (reads.masses)
        b.masses[k] = body.mass;
      if (reads.radii)
        b.radii[k] = body.radius;
    }
    std::fill_n(b.accelerations, 3 * count, 0.0);
  }

  // Returns false if one is not finite.
  static bool take(const Block& b, std::span<Vec3> accelerations, double scale) {
    double* const to = accelerations.front().data();
    const std::size_t count = 3 * accelerations.size();
    double sums[4] = {}; // of terms that are 0, or nan
    for (std::size_t k = 0; k < count / 4 * 4; k += 4)
      for (std::size_t lane = 0; lane < 4; ++lane) {
        to[k + lane] = scale * b.accelerations[k + lane];
        sums[lane] += to[k + lane] - to[k + lane];
      }
    for (std::size_t k = count / 4 * 4; k < count; ++k) {
      to[k] = scale * b.accelerations[k];
      sums[0] += to[k] - to[k];
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]) == 0.0;
  }

  std::string name_;
  CompiledForceFunction function_;
  ReadArrays reads_;
  std::vector<double> keys_;
  double omega_;
};

// The keys of a force, with one more: changes of a formula must show in the state hash, and a stored scene would lose
// an empty table.
std::vector<Key> force_keys(const py::list& declared) {
  std::vector<Key> keys = keys_from(declared);
  keys.push_back({.path = "version",
                  .type = KeyType::integer,
                  .fallback = "1",
                  .unit = "1",
                  .meaning = "version of the function; another one is another state hash",
                  .range = {.low = 0, .high = 1e9}});
  return keys;
}

void add_python_force(const std::string& name, py::object function, const py::list& declared) {
  const std::vector<Key> keys = force_keys(declared);
  forces::add_force({kept_text(name), keys,
                     [name, keys, function = KeptObject(std::move(function))](const Parameters& p,
                                                                              const forces::ForceContext& context) {
                       return std::make_unique<PythonForce>(name, function, keys, p, context.orbital_frequency);
                     }},
                    IfTaken::replace);
}

void add_compiled_force(const std::string& name, std::uintptr_t address, const py::list& declared,
                        const std::vector<std::string>& read) {
  assert(address != 0);
  const ReadArrays reads(read);
  const auto function =
      reinterpret_cast<CompiledForceFunction>(address); // NOLINT(performance-no-int-to-ptr): ctypes gives numbers
  const std::vector<Key> keys = force_keys(declared);
  forces::add_force({kept_text(name), keys,
                     [name, keys, function, reads](const Parameters& p, const forces::ForceContext& context) {
                       std::vector<double> values;
                       for (const Key& key : keys)
                         if (key.type == KeyType::number)
                           values.push_back(p.number(key.path));
                       return std::make_unique<CompiledForce>(name, function, reads, std::move(values),
                                                              context.orbital_frequency);
                     }},
                    IfTaken::replace);
}

} // namespace

void bind_own_forces(py::module_& module) {
  py::class_<Kick, std::shared_ptr<Kick>>(module, "Kick")
      .def("__len__", &Kick::size)
      .def_property_readonly("positions", &Kick::positions)
      .def_property_readonly("velocities", &Kick::velocities)
      .def_property_readonly("velocities_beyond_shear", &Kick::beyond_shear)
      .def_property_readonly("masses", &Kick::masses)
      .def_property_readonly("radii", &Kick::radii)
      .def_property_readonly("ids", &Kick::ids)
      .def_property_readonly("orbits", &Kick::orbits)
      .def_property_readonly("interval", &Kick::interval)
      .def_property_readonly("orbital_frequency", &Kick::orbital_frequency)
      .def_property_readonly("box", &Kick::box)
      .def_property_readonly("shear_offset", &Kick::shear_offset)
      .def_property_readonly("keys", &Kick::keys);
  module.def("add_python_force", &add_python_force, py::arg("name"), py::arg("function"), py::arg("keys"));
  module.def("add_compiled_force", &add_compiled_force, py::arg("name"), py::arg("address"), py::arg("keys"),
             py::arg("reads"));
}

} // namespace keeler::python
