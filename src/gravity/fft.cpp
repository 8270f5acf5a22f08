#include <keeler/gravity/fft.hpp>

#include "force_split.hpp"
#include "mesh.hpp"
#include "near_forces.hpp"
#include "places.hpp"
#include "self_force.hpp"
#include "sheared_transform.hpp"
#include "wave_kernel.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace keeler {
namespace {

// Distance of planes in spacings. The layer is thin and its vertical pull coherent: an error along z shows most.
constexpr double flatness = 0.5;

// k times the spacing in the corner of a square mesh.
constexpr double highest_wave = 1.4142135623730951 * pi;

// Wave number, per radius of the cloud, below which it keeps its power: near the least error in even states and in
// clumped ones.
double band_for(double cut) {
  return std::min(1.25 + 2.0 * cut, 17.0);
}

// Particles between a lowest and a highest one.
struct Extent {
  double low, high;
};

Extent extent_of(std::span<const Vec3> positions) {
  if (!std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); }))
    throw InvariantError("a particle stands at no finite place; take a shorter time.step");
  Extent z{positions.front().z(), positions.front().z()};
  for (const Vec3& p : positions) {
    z.low = std::min(z.low, p.z());
    z.high = std::max(z.high, p.z());
  }
  return z;
}

// The spacing, made larger where the mesh would hold very many nodes a particle: few particles in a large box, or some
// that have strayed far from the layer. Clouds grow with it, so the error stays what it was, and neighbours cost more.
double affordable_spacing(const ShearingBox& box, double spacing, const Extent& z, std::size_t count) {
  const double most = 0x1p21 + 64.0 * static_cast<double>(count);
  const auto nodes = [&](double step) {
    return box.size_x / step * (box.size_y / step) * ((z.high - z.low) / (flatness * step) + 4.0);
  };
  while (nodes(spacing) > most)
    spacing *= 1.1;
  return spacing;
}

// About 8 particles a tile: few enough to be close together, and enough to share the search for their neighbours.
Tiling tiling_for(const MeshShape& shape, std::size_t count) {
  const double cells = static_cast<double>(shape.columns) * static_cast<double>(shape.rows);
  const double side = std::round(std::sqrt(8.0 * cells / static_cast<double>(count)));
  const double longest = static_cast<double>(std::max(shape.columns, shape.rows));
  return {shape.columns, shape.rows, static_cast<std::size_t>(std::clamp(side, 1.0, longest))};
}

} // namespace

double mass_spread(std::span<const double> masses) {
  const double sum = exact_sum(masses.size(), [&](std::size_t k) { return masses[k]; });
  const double squares = exact_sum(masses.size(), [&](std::size_t k) { return masses[k] * masses[k]; });
  return sum > 0.0 ? std::sqrt(squares * static_cast<double>(masses.size())) / sum : 1.0;
}

// The errors of equal spheres, a little more than measured in fresh and clumped patches (docs/dev/gravity-fft.md); what
// they are multiplied by for other sizes is fitted to the patches there.
double cut_for(double force_error, double mass_spread) {
  struct Measured {
    double cut, error;
  };
  constexpr Measured measured[] = {{2.0, 5e-3},   {2.5, 1.8e-3}, {3.0, 1.3e-3}, {4.0, 6.5e-4},
                                   {6.0, 2.1e-4}, {8.0, 7e-5},   {12.0, 1.5e-5}};
  const double wanted = force_error / std::clamp(std::pow(mass_spread, 0.7), 1.0, 6.0);
  const Measured* after = std::find_if(std::begin(measured) + 1, std::end(measured) - 1,
                                       [&](const Measured& m) { return m.error < wanted; });
  const Measured* before = after - 1;
  const double slope = std::log(before->error / after->error) / std::log(after->cut / before->cut);
  return std::clamp(after->cut * std::pow(after->error / wanted, 1.0 / slope), 2.0, 16.0);
}

struct FftSolver::Parts {
  Parts(const FftSettings& chosen, InstructionSet set)
      : settings(chosen), kernels(mesh_kernels(set)), split(band_for(chosen.cut)),
        waves(split, chosen.cut / flatness, highest_wave * flatness), near(split, set) {}

  void spread(const GravityProblem& problem, double offset);
  void fill_mesh(const GravityProblem& problem, double offset);
  double mesh_potential(const GravityProblem& problem, double offset);
  NearForces::Energy near_energy(const GravityProblem& problem, double offset);
  Vec3 accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile, std::span<Vec3> accelerations);

  FftSettings settings;
  MeshKernels kernels;
  ForceSplit split;
  WaveKernel waves;
  NearForces near;
  Places places;
  Mesh mesh;
  ShearedTransform transform;
  double radius = 0.0; // of the clouds in this solve, m
  SelfForce self{};
};

// Sorts the particles and spreads their masses on the mesh.
void FftSolver::Parts::spread(const GravityProblem& problem, double offset) {
  const std::size_t count = problem.positions.size();
  const Extent z = extent_of(problem.positions);
  const double spacing = affordable_spacing(problem.box, settings.spacing, z, count);
  radius = settings.cut * spacing;
  const MeshShape shape = mesh_shape(problem.box, spacing, flatness * spacing, z.low, z.high);
  self = self_force(shape, split, radius);
  places.sort(problem, offset, tiling_for(shape, count));
  mesh.reset(shape);
  mesh.spread(places, kernels);
  transform.prepare(shape, offset / problem.box.size_y);
  waves.prepare(shape);
}

// Turns the particles' masses into the potential on the mesh.
void FftSolver::Parts::fill_mesh(const GravityProblem& problem, double offset) {
  spread(problem, offset);
  const MeshShape& shape = mesh.shape();
  transform.apply(mesh, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(shape, transform, m, kernels, from, to);
  });
}

// Returns Σ m a over the tile, in units of mass.
Vec3 FftSolver::Parts::accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile,
                                       std::span<Vec3> accelerations) {
  const double unit = problem.newton_g * places.mass_unit(), near_unit = unit / (radius * radius);
  const std::size_t first = places.first(tile), in_tile = places.first(tile + 1) - first;
  const std::size_t groups = (in_tile + NearTargets::capacity - 1) / NearTargets::capacity;
  Vec3 sum = Vec3::Zero();
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t begin = first + in_tile * g / groups, count = first + in_tile * (g + 1) / groups - begin;
    const ParticleRange range = places.range(begin, count);
    float x[NearTargets::capacity], y[NearTargets::capacity], z[NearTargets::capacity];
    kernels.pull(mesh.numbers(), range, self, x, y, z);
    NearTargets near_by;
    if (settings.short_range)
      near.attract(places, problem.box, offset, radius, begin, count, near_by);
    for (std::size_t k = 0; k < count; ++k) {
      Vec3 a = unit * Vec3(x[k], y[k], z[k]);
      if (settings.short_range)
        a += near_unit * Vec3(near_by.ax[k], near_by.ay[k], near_by.az[k]);
      accelerations[places.index(begin + k)] = a;
      sum += static_cast<double>(range.mass[k]) * a;
    }
  }
  return sum;
}

// ½ Σ m_i m_j of the clouds' potential at the other particles, wave by wave, in units of mass: a particle's potential
// in its own cloud is taken out.
double FftSolver::Parts::mesh_potential(const GravityProblem& problem, double offset) {
  spread(problem, offset);
  const MeshShape& shape = mesh.shape();
  std::vector<double> sums(transform.waves());
  transform.visit(mesh, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(shape, transform, m, kernels, from, to);
    double sum = 0.0;
    for (std::size_t p = 0; p < shape.planes; ++p)
      for (std::size_t n = 0; n < shape.columns; ++n) {
        const std::size_t at = p * transform.row_length() + n;
        sum += static_cast<double>(from[at].real()) * static_cast<double>(to[at].real()) +
               static_cast<double>(from[at].imag()) * static_cast<double>(to[at].imag());
      }
    sums[m] = m == 0 ? 0.5 * sum : sum; // waves −m count as much
  });
  const ParticleRange all = places.range(0, places.count());
  const double squares =
      exact_sum(all.count, [&](std::size_t k) { return static_cast<double>(all.mass[k]) * all.mass[k]; });
  return exact_sum(sums.size(), [&](std::size_t m) { return sums[m]; }) - 0.5 * squares * split.potential()[0] / radius;
}

// Of the mesh that mesh_potential() had.
NearForces::Energy FftSolver::Parts::near_energy(const GravityProblem& problem, double offset) {
  places.sort(problem, offset, tiling_for(mesh.shape(), problem.positions.size()));
  struct Sums {
    ExactSum potential, stress;

    Sums& operator+=(const Sums& more) {
      potential += more.potential;
      stress += more.stress;
      return *this;
    }
  };
  const Sums sums = exact_total<Sums>(places.tiling().count(), [&](Sums& total, std::size_t tile) {
    for (std::size_t begin = places.first(tile); begin < places.first(tile + 1); begin += NearTargets::capacity) {
      const NearForces::Energy energy = near.energy(places, problem.box, offset, radius, begin,
                                                    std::min(NearTargets::capacity, places.first(tile + 1) - begin));
      total.potential += energy.potential;
      total.stress += energy.stress;
    }
  });
  return {sums.potential.value(), sums.stress.value()};
}

FftSolver::FftSolver(const FftSettings& settings, InstructionSet set)
    : parts_(std::make_unique<Parts>(settings, set)) {}

FftSolver::~FftSolver() = default;

std::string FftSolver::name() const {
  return parts_->settings.short_range ? "fft" : "mesh";
}

void FftSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const std::size_t count = problem.positions.size();
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  parts_->fill_mesh(problem, offset);
  std::vector<Vec3> sums(parts_->places.tiling().count());
  parallel_for(
      sums.size(),
      [&](std::size_t tile) { sums[tile] = parts_->accelerate_tile(problem, offset, tile, accelerations); }, 4);

  // the gradient of the mesh's energy leaves a net force of the order of its error; attraction has none
  const auto total = exact_total<ExactVec3>(sums.size(), [&](ExactVec3& all, std::size_t tile) { all += sums[tile]; });
  const Vec3 mean = total.value() / static_cast<double>(count); // masses are in units of their mean
  parallel_for(count, [&](std::size_t k) { accelerations[k] -= mean; });
}

// The mesh's part of dΦ/dγ is a difference: particles and box are sheared a little to both sides.
GravityEnergy FftSolver::energy(const GravityProblem& problem) {
  const std::size_t count = problem.positions.size();
  if (count == 0)
    return {};
  constexpr double strain = 5e-3;
  double potentials[2] = {};
  std::vector<Vec3> sheared(count);
  for (const double sign : {-1.0, 1.0}) {
    parallel_for(count, [&](std::size_t k) {
      sheared[k] = problem.positions[k] - Vec3(0.0, sign * strain * problem.positions[k].x(), 0.0);
    });
    GravityProblem turned = problem;
    turned.positions = sheared;
    const double offset = folded_offset(problem.box, problem.offset + sign * strain * problem.box.size_x);
    potentials[sign > 0.0] = parts_->mesh_potential(turned, offset);
  }
  NearForces::Energy near;
  if (parts_->settings.short_range) {
    near = parts_->near_energy(problem, folded_offset(problem.box, problem.offset));
    const double half = 0.5 / parts_->radius; // pairs count twice
    near = {half * near.potential, half * near.stress};
  }
  const double mass = parts_->places.mass_unit(), unit = problem.newton_g * mass * mass;
  return {-unit * (0.5 * (potentials[0] + potentials[1]) + near.potential),
          -unit * (0.5 * (potentials[1] - potentials[0]) / strain + near.stress)};
}

} // namespace keeler
