#include "reference_forces.hpp"

#include <keeler/core/simd.hpp>
#include <keeler/gravity/direct.hpp>

namespace keeler::runs {

double force_tolerance(const gravity::GravitySettings& settings) {
  using Solver = gravity::GravitySettings::Solver;
  switch (settings.solver) {
  case Solver::direct:
    return 1e-4; // one ring of images and the far field: docs/theory/gravity.md
  case Solver::tree: {
    const double relative = settings.opening_angle / 0.6; // docs/dev/gravity.md
    return 1e-3 * relative * relative * relative * relative + 1e-4;
  }
  case Solver::fft:
  case Solver::automatic:
    return settings.force_error;
  default:
    return 0.0;
  }
}

bool sums_over_pairs(const gravity::GravitySettings& settings) {
  using Solver = gravity::GravitySettings::Solver;
  return settings.solver == Solver::direct || settings.solver == Solver::tree;
}

gravity::ImageSettings reference_images(const gravity::GravitySettings& settings) {
  constexpr double one_ring_suffices = 1e-3;
  return {.rings = sums_over_pairs(settings) || force_tolerance(settings) < one_ring_suffices ? 2 : 1};
}

std::vector<Vec3> reference_forces(const gravity::GravityProblem& problem, std::span<const std::size_t> sample,
                                   const gravity::GravitySettings& settings, const gravity::ImageSettings& images) {
  using gravity::Precision;
  constexpr double single_suffices = 1e-5;
  return sampled_accelerations(problem, sample, images, choose_instruction_set(),
                               force_tolerance(settings) < single_suffices ? Precision::double_precision
                                                                           : Precision::single_precision);
}

} // namespace keeler::runs
