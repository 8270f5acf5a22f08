#include <keeler/gravity/fft.hpp>

#include "force_split.hpp"
#include "mesh.hpp"
#include "near_forces.hpp"
#include "places.hpp"
#include "self_force.hpp"
#include "sheared_transform.hpp"
#include "wave_kernel.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

// Wave number, per radius of the cloud, below which it keeps its power: least error at these cuts.
double band_for(double cut) {
  return 4.0 * std::sqrt(cut);
}

// Distance of planes in spacings. The layer is thin, and its vertical pull coherent: an error in z shows most.
const double flatness = getenv("FLAT") ? atof(getenv("FLAT")) : 0.6;

// k times the spacing in the corner of a square mesh.
constexpr double highest_wave = 1.4142135623730951 * pi;

Tiling tiling_for(const MeshShape& shape, std::size_t count) {
  const double cells = static_cast<double>(shape.columns) * static_cast<double>(shape.rows);
  const double side = std::round(std::sqrt((getenv("PT") ? atof(getenv("PT")) : 10.0) * cells / static_cast<double>(count)));
  return {shape.columns, shape.rows, static_cast<std::size_t>(std::clamp(side, 1.0, 1e4))};
}

} // namespace

struct FftSolver::Parts {
  Parts(const FftSettings& chosen, InstructionSet set)
      : settings(chosen), kernels(mesh_kernels(set)), split(band_for(chosen.cut)), waves(split, chosen.cut / flatness, highest_wave * flatness),
        near(split, chosen.cut * chosen.spacing, set) {}

  FftSettings settings;
  MeshKernels kernels;
  ForceSplit split;
  WaveKernel waves;
  NearForces near;
  Places places;
  Mesh mesh;
  ShearedTransform transform;
};

FftSolver::FftSolver(const FftSettings& settings, InstructionSet set)
    : parts_(std::make_unique<Parts>(settings, set)) {}

FftSolver::~FftSolver() = default;

void FftSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const std::size_t count = problem.positions.size();
  if (count == 0)
    return;
  Parts& p = *parts_;
  const double offset = folded_offset(problem.box, problem.offset);
  const auto [lowest, highest] = std::minmax_element(problem.positions.begin(), problem.positions.end(),
                                                     [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  const MeshShape shape = mesh_shape(problem.box, p.settings.spacing, flatness * p.settings.spacing, lowest->z(), highest->z());
  const double radius = p.settings.cut * p.settings.spacing;
  const SelfForce self = self_force(shape, p.split, radius);
  const Tiling tiling = tiling_for(shape, count);
  p.places.sort(problem, offset, tiling);
  p.mesh.reset(shape);
  p.mesh.spread(p.places, p.kernels);
  p.transform.prepare(shape, offset / problem.box.size_y);
  p.transform.apply(p.mesh, [&](std::size_t m, const std::complex<float>* from, std::complex<float>* to) {
    p.waves.apply(shape, p.transform, m, p.kernels, from, to);
  });

  const double unit = problem.newton_g * p.places.mass_unit(), near_unit = unit / (radius * radius);
  const MeshNumbers mesh = p.mesh.numbers();
  parallel_for(
      tiling.count(),
      [&](std::size_t tile) {
        const std::size_t first = p.places.first(tile), in_tile = p.places.first(tile + 1) - first;
        const std::size_t groups = (in_tile + NearTargets::capacity - 1) / NearTargets::capacity;
        for (std::size_t g = 0; g < groups; ++g) {
          const std::size_t begin = first + in_tile * g / groups, end = first + in_tile * (g + 1) / groups;
          NearTargets near;
          if (p.settings.short_range)
            p.near.add(p.places, problem.box, offset, begin, end - begin, near);
          float x[NearTargets::capacity], y[NearTargets::capacity], z[NearTargets::capacity];
          p.kernels.pull(mesh, p.places.range(begin, end - begin), self, x, y, z);
          for (std::size_t k = 0; k < end - begin; ++k) {
            const Vec3 far = unit * Vec3(x[k], y[k], z[k]);
            const Vec3 close = p.settings.short_range ? Vec3(near_unit * Vec3(near.ax[k], near.ay[k], near.az[k])) : Vec3::Zero();
            accelerations[p.places.index(begin + k)] = far + close;
          }
        }
      },
      4);
}

} // namespace keeler
