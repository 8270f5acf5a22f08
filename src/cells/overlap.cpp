#include <keeler/cells/overlap.hpp>

#include <keeler/cells/grid.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace keeler::cells {
namespace {

// Measured from the particle with the lower id, so that the bits do not depend on which of the two found the pair.
Overlap overlap_of(const Patch& patch, std::size_t low, std::size_t high, const Image& image_of_high) {
  assert(patch.ids[low] < patch.ids[high]);
  const Vec3 d = patch.positions[high] + patch.box.displacement(image_of_high, patch.offset) - patch.positions[low];
  const double sum = patch.radii[low] + patch.radii[high];
  return {(sum - d.norm()) / sum, patch.ids[low], patch.ids[high]};
}

// Calls visit(overlap) for each overlapping pair, from any thread. The larger particle of a pair searches for the
// smaller one, so that only large particles have a long reach.
template<class Visit> void for_each_overlap(const Patch& patch, const Visit& visit) {
  if (patch.size() == 0)
    return;
  const std::vector<double>& radii = patch.radii;
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(patch.size());
  PeriodicGrid grid;
  grid.build(patch.positions, patch.box, patch.offset, 2.0 * mean);
  parallel_for(patch.size(), [&](std::size_t i) {
    const double reach = 2.0 * radii[i];
    grid.visit_near(patch.positions[i], reach, reach, [&](std::size_t j, const Image& image) {
      const bool lower = patch.ids[i] < patch.ids[j];
      if (patch.ids[j] == patch.ids[i] || radii[j] > radii[i] || (radii[j] == radii[i] && !lower))
        return;
      const Overlap here = lower ? overlap_of(patch, i, j, image) : overlap_of(patch, j, i, -image);
      if (here.depth > 0.0)
        visit(here);
    });
  });
}

} // namespace

bool deeper(const Overlap& a, const Overlap& b) {
  if (a.depth != b.depth)
    return a.depth > b.depth;
  return std::pair(a.id_i, a.id_j) < std::pair(b.id_i, b.id_j);
}

Overlap largest_overlap(const Patch& patch) {
  std::vector<Overlap> worst(static_cast<std::size_t>(threads())); // per thread
  for_each_overlap(patch, [&](const Overlap& overlap) {
    Overlap& deepest = worst[static_cast<std::size_t>(omp_get_thread_num()) % worst.size()];
    if (deeper(overlap, deepest))
      deepest = overlap;
  });
  Overlap result;
  for (const Overlap& candidate : worst)
    if (candidate.depth > 0.0 && deeper(candidate, result))
      result = candidate;
  return result;
}

std::size_t count_overlaps(const Patch& patch, double depth) {
  std::atomic<std::size_t> count = 0;
  for_each_overlap(patch, [&](const Overlap& overlap) { count += overlap.depth > depth ? 1 : 0; });
  return count;
}

void require_no_heap(const Patch& patch, const std::string& state) {
  assert(patch.radii.size() == patch.size());
  const std::size_t count = patch.size();
  const double width = 2.0 * std::accumulate(patch.radii.begin(), patch.radii.end(), 0.0) / static_cast<double>(count);
  std::vector<std::pair<double, double>> cells(count);
  for (std::size_t k = 0; k < count; ++k)
    cells[k] = {std::floor(patch.positions[k].x() / width), std::floor(patch.positions[k].y() / width)};
  std::sort(cells.begin(), cells.end());
  double pairs = 0.0;
  for (std::size_t first = 0, next = 0; first < count; first = next) {
    while (next < count && cells[next] == cells[first])
      ++next;
    pairs += std::pow(static_cast<double>(next - first), 2);
  }
  constexpr double always_allowed = 1e7, allowed_each = 1000.0; // pairs; a layer has some tens per particle
  if (pairs > always_allowed + allowed_each * static_cast<double>(count))
    throw InvariantError(
        fmt::format("the {} of {} lie on each other in heaps (a column as wide as a particle holds {} on "
                    "the mean); spread them out",
                    pluralize(count, "particle"), state, format_number(pairs / static_cast<double>(count), 3)));
}

void require_no_overlap(const Patch& patch, const std::string& state) {
  require_no_heap(patch, state);
  require_no_overlap(largest_overlap(patch), state);
}

void require_no_overlap(const Overlap& largest, const std::string& state) {
  if (largest.depth > allowed_overlap)
    throw InvariantError(fmt::format("particles {} and {} of {} overlap by {:.2e} of their radius sum; start from a "
                                     "state without overlaps",
                                     largest.id_i, largest.id_j, state, largest.depth));
}

} // namespace keeler::cells
