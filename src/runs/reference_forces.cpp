#include "reference_forces.hpp"

#include <keeler/core/simd.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/particles/by_id.hpp>
#include <keeler/particles/order.hpp>

#include <cassert>

namespace keeler::runs {
namespace {

// The particles at these places in the order of ids.
std::vector<std::size_t> sample_at(std::span<const std::uint64_t> ids, std::span<const std::size_t> places) {
  const std::vector<std::uint32_t> order = particles::order_by_id(ids);
  std::vector<std::size_t> sample;
  for (const std::size_t place : places)
    sample.push_back(order[place]);
  return sample;
}

// Returns on all ranks the accelerations of particles by id, each known to its owner.
[[maybe_unused]] std::vector<Vec3> rows_of_ranks(const gravity::GravityProblem& problem,
                                                 std::span<const Vec3> accelerations,
                                                 const std::vector<std::uint64_t>& ids) {
  struct Row {
    Vec3 acceleration;
    std::uint64_t number; // in the sample
  };
  std::vector<Row> own;
  for (std::size_t k = 0; k < problem.ids.size(); ++k)
    for (std::size_t n = 0; n < ids.size(); ++n)
      if (ids[n] == problem.ids[k])
        own.push_back({accelerations[k], n});
  std::vector<Vec3> rows(ids.size());
  for (const Row& row : problem.ranks.gather_on_all(std::span<const Row>(own)))
    rows[row.number] = row.acceleration;
  return rows;
}

} // namespace

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

ComparedForces compare_forces(const gravity::GravityProblem& problem, std::span<const Vec3> accelerations,
                              std::span<const std::size_t> places, const gravity::GravitySettings& settings,
                              const gravity::ImageSettings& images) {
  using gravity::Precision;
  constexpr double single_suffices = 1e-5;
  assert(accelerations.size() == problem.positions.size());
  const Precision precision =
      force_tolerance(settings) < single_suffices ? Precision::double_precision : Precision::single_precision;
  const InstructionSet set = choose_instruction_set();
  ComparedForces compared;
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed()) {
      compared.ids = particles::ids_at(problem.ids, problem.ranks, places);
      compared.exact = sampled_accelerations_of_ranks(problem, compared.ids, images, set, precision);
      compared.found = rows_of_ranks(problem, accelerations, compared.ids);
      return compared;
    }
  const std::vector<std::size_t> sample = sample_at(problem.ids, places);
  for (const std::size_t k : sample) {
    compared.ids.push_back(problem.ids[k]);
    compared.found.push_back(accelerations[k]);
  }
  compared.exact = sampled_accelerations(problem, sample, images, set, precision);
  return compared;
}

} // namespace keeler::runs
