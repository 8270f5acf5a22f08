#include "fft_parts.hpp"

#include <keeler/core/exact_sum.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <vector>

namespace keeler::gravity {
namespace {

// Largest wave number times the spacing on a square mesh: the corner of its Brillouin zone.
constexpr double max_wave = 1.4142135623730951 * pi;

// Returns the wave number, per radius of the cloud, below which the cloud keeps its power: near the minimum of the
// error in even and in clumped states.
double band_for(double cut) {
  return std::min(1.25 + 2.0 * cut, 17.0);
}

} // namespace

double mass_spread(std::span<const double> masses, const Communicator& ranks) {
  auto sum = exact_total<ExactSum>(masses.size(), [&](ExactSum& total, std::size_t k) { total += masses[k]; });
  auto squares =
      exact_total<ExactSum>(masses.size(), [&](ExactSum& total, std::size_t k) { total += masses[k] * masses[k]; });
  ranks.merge({&sum, &squares});
  const double mass = sum.value(), count = static_cast<double>(ranks.sum(masses.size()));
  return mass > 0.0 ? std::sqrt(squares.value() * count) / mass : 1.0;
}

MeshSize mesh_size(const ShearingBox& box, double spacing, double height, std::size_t count) {
  const Extent z{-0.5 * height, 0.5 * height};
  const double step = affordable_spacing(box, spacing, z, count);
  return {mesh_nodes(box, step, z), box.area() / (step * step)};
}

// Nodes are floats; between the transforms half as many complex waves take their place; each column of waves has
// phases.
double max_mesh_bytes(const ShearingBox& box, double spacing, double height, std::size_t count) {
  const double nodes = std::min(mesh_nodes(box, spacing, {-0.5 * height, 0.5 * height}), max_mesh_nodes(count));
  return sizeof(float) * nodes + sizeof(std::complex<float>) * mesh_size(box, spacing, height, count).cells;
}

// The table has errors of equal spheres, a little above the measured ones in fresh and clumped patches
// (docs/dev/gravity-fft.md). The factor for other sizes is fitted to the patches there.
double cut_for(double force_error, double mass_spread) {
  struct Measured {
    double cut, error;
  };
  constexpr Measured measured[] = {{2.0, 5e-3},   {2.5, 1.8e-3}, {3.0, 1.3e-3}, {4.0, 6.5e-4},
                                   {6.0, 2.1e-4}, {8.0, 7e-5},   {12.0, 1.5e-5}};
  assert(force_error > 0.0 && mass_spread > 0.0);
  const double target = force_error / std::clamp(std::pow(mass_spread, 0.7), 1.0, 6.0);
  const Measured* after = std::find_if(std::begin(measured) + 1, std::end(measured) - 1,
                                       [&](const Measured& m) { return m.error < target; });
  const Measured* before = after - 1;
  const double slope = std::log(before->error / after->error) / std::log(after->cut / before->cut);
  return std::clamp(after->cut * std::pow(after->error / target, 1.0 / slope), 2.0, 16.0);
}

FftSolver::Parts::Parts(const FftSettings& chosen, InstructionSet set)
    : settings(chosen), kernels(mesh_kernels(set)), split(band_for(chosen.cut)),
      waves(split, chosen.cut / plane_spacing_ratio, max_wave * plane_spacing_ratio), near(split, set) {}

MeshShape FftSolver::Parts::choose_mesh(const ShearingBox& box, const Extent& z, std::size_t count) {
  assert(count > 0 && z.low <= z.high);
  require_layer(box, z);
  const double spacing = affordable_spacing(box, settings.spacing, z, count);
  radius = settings.cut * spacing;
  const MeshShape shape = mesh_shape(box, spacing, plane_spacing_ratio * spacing, z.low, z.high);
  self = self_force(shape, split, radius);
  return shape;
}

void FftSolver::Parts::spread(const GravityProblem& problem, double offset) {
  assert(!problem.ranks.distributed());
  const std::size_t count = problem.positions.size();
  const MeshShape shape = choose_mesh(problem.box, extent_of(problem.positions), count);
  sorted.sort(problem, offset, tiling_for(shape, count));
  mesh.reset(shape);
  mesh.spread(sorted, kernels);
  transform.prepare(shape, offset / problem.box.size_y);
  waves.prepare(shape);
}

void FftSolver::Parts::fill_mesh(const GravityProblem& problem, double offset) {
  spread(problem, offset);
  const MeshShape& shape = mesh.shape();
  transform.apply(mesh, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(shape, transform, m, kernels, from, to);
  });
}

Vec3 FftSolver::Parts::accelerate_tile(const GravityProblem& problem, double offset, std::size_t tile,
                                       std::span<Vec3> accelerations) {
  const double unit = problem.newton_g * sorted.mass_unit(), near_unit = unit / (radius * radius);
  const std::size_t first = sorted.first(tile), in_tile = sorted.end(tile) - first;
  const std::size_t groups = (in_tile + NearTargets::capacity - 1) / NearTargets::capacity;
  Vec3 sum = Vec3::Zero();
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t begin = first + in_tile * g / groups, count = first + in_tile * (g + 1) / groups - begin;
    const ParticleRange range = sorted.range(begin, count);
    float x[NearTargets::capacity], y[NearTargets::capacity], z[NearTargets::capacity];
    kernels.interpolate(mesh.view(), range, self, x, y, z);
    NearTargets near_by;
    if (settings.short_range)
      near.attract(sorted, problem.box, offset, radius, begin, count, near_by);
    for (std::size_t k = 0; k < count; ++k) {
      Vec3 a = unit * Vec3(x[k], y[k], z[k]);
      if (settings.short_range)
        a += near_unit * Vec3(near_by.ax[k], near_by.ay[k], near_by.az[k]);
      accelerations[sorted.index(begin + k)] = a;
      sum += static_cast<double>(range.mass[k]) * a;
    }
  }
  return sum;
}

double FftSolver::Parts::wave_potential(std::size_t m, const std::complex<float>* masses,
                                        const std::complex<float>* potential) const {
  const MeshShape& shape = mesh.shape();
  double sum = 0.0;
  for (std::size_t p = 0; p < shape.planes; ++p)
    for (std::size_t n = 0; n < shape.columns; ++n) {
      const std::size_t at = p * transform.row_length() + n;
      sum += static_cast<double>(masses[at].real()) * static_cast<double>(potential[at].real()) +
             static_cast<double>(masses[at].imag()) * static_cast<double>(potential[at].imag());
    }
  return m == 0 ? 0.5 * sum : sum; // waves −m contribute the same
}

ExactSum FftSolver::Parts::squared_masses(std::size_t begin, std::size_t end) const {
  assert(begin <= end);
  const ParticleRange some = sorted.range(begin, end - begin);
  return exact_total<ExactSum>(
      some.count, [&](ExactSum& sum, std::size_t k) { sum += static_cast<double>(some.mass[k]) * some.mass[k]; });
}

double FftSolver::Parts::mesh_potential(const GravityProblem& problem, double offset) {
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed())
      return mesh_potential_distributed(problem, offset);
  spread(problem, offset);
  std::vector<double> sums(transform.waves());
  transform.visit(mesh, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    waves.apply(mesh.shape(), transform, m, kernels, from, to);
    sums[m] = wave_potential(m, from, to);
  });
  const double squares = squared_masses(0, sorted.count()).value();
  return exact_sum(sums.size(), [&](std::size_t m) { return sums[m]; }) - 0.5 * squares * split.potential()[0] / radius;
}

NearSums FftSolver::Parts::near_sums(const ShearingBox& box, double offset, std::size_t first_tile, std::size_t tiles) {
  return exact_total<NearSums>(tiles, [&](NearSums& total, std::size_t k) {
    const std::size_t end = sorted.end(first_tile + k);
    for (std::size_t begin = sorted.first(first_tile + k); begin < end; begin += NearTargets::capacity) {
      const NearForces::Energy energy =
          near.energy(sorted, box, offset, radius, begin, std::min(NearTargets::capacity, end - begin));
      total.potential += energy.potential;
      total.stress += energy.stress;
    }
  });
}

NearForces::Energy FftSolver::Parts::near_energy(const GravityProblem& problem, double offset) {
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed())
      return near_energy_distributed(problem, offset);
  assert(radius > 0.0); // mesh_potential() chose the mesh
  sorted.sort(problem, offset, tiling_for(mesh.shape(), problem.positions.size()));
  const NearSums sums = near_sums(problem.box, offset, 0, sorted.tiling().count());
  return {sums.potential.value(), sums.stress.value()};
}

FftSolver::FftSolver(const FftSettings& settings, InstructionSet set) : parts_(std::make_unique<Parts>(settings, set)) {
  assert(settings.spacing >= 0.0 && settings.cut >= 1.0);
}

FftSolver::~FftSolver() = default;

std::string FftSolver::name() const {
  return parts_->settings.short_range ? "fft" : "mesh";
}

void FftSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  assert(accelerations.size() == problem.positions.size());
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed())
      return parts_->accelerate_distributed(problem, accelerations);
  const std::size_t count = problem.positions.size();
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  parts_->fill_mesh(problem, offset);
  std::vector<Vec3> sums(parts_->sorted.tiling().count());
  parallel_for(
      sums.size(),
      [&](std::size_t tile) { sums[tile] = parts_->accelerate_tile(problem, offset, tile, accelerations); }, 4);

  // the gradient of the mesh's energy has a net force of the order of its error, which attraction has not: subtract it
  const auto total = exact_total<ExactVec3>(sums.size(), [&](ExactVec3& all, std::size_t tile) { all += sums[tile]; });
  const Vec3 mean = total.value() / static_cast<double>(count); // masses are in units of their mean
  parallel_for(count, [&](std::size_t k) { accelerations[k] -= mean; });
  parts_->release();
}

// The mesh's part of dΦ/dγ is a central difference: particles and box are sheared by ± strain.
GravityEnergy FftSolver::energy(const GravityProblem& problem) {
  const std::size_t count = problem.positions.size();
  if (problem.ranks.sum(count) == 0)
    return {};
  constexpr double strain = 5e-3;
  double potentials[2] = {};
  std::vector<Vec3> sheared(count);
  for (const double sign : {-1.0, 1.0}) {
    parallel_for(count, [&](std::size_t k) {
      sheared[k] = problem.positions[k] - Vec3(0.0, sign * strain * problem.positions[k].x(), 0.0);
    });
    GravityProblem strained = problem;
    strained.positions = sheared;
    const double offset = folded_offset(problem.box, problem.offset + sign * strain * problem.box.size_x);
    potentials[sign > 0.0] = parts_->mesh_potential(strained, offset);
  }
  NearForces::Energy near;
  if (parts_->settings.short_range) {
    near = parts_->near_energy(problem, folded_offset(problem.box, problem.offset));
    const double half = 0.5 / parts_->radius; // each pair is summed twice
    near = {half * near.potential, half * near.stress};
  }
  parts_->release();
  const double mass = parts_->sorted.mass_unit(), unit = problem.newton_g * mass * mass;
  return {-unit * (0.5 * (potentials[0] + potentials[1]) + near.potential),
          -unit * (0.5 * (potentials[1] - potentials[0]) / strain + near.stress)};
}

} // namespace keeler::gravity
