#include "places.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>

namespace keeler {

void Places::sort(const GravityProblem& problem, double offset, const Tiling& tiling) {
  const std::size_t count = problem.positions.size();
  const bool same_count = index_.size() == count;
  tiling_ = tiling;
  const double left = -0.5 * problem.box.size_x, bottom = -0.5 * problem.box.size_y;
  const double columns_per_metre = static_cast<double>(tiling.columns) / problem.box.size_x;
  const double rows_per_metre = static_cast<double>(tiling.rows) / problem.box.size_y;
  constexpr std::size_t ahead = 24;
  found_.resize(count);
  tile_of_.resize(count);
  sorted_.resize(count);
  parallel_for(count, [&](std::size_t k) {
    // in the order of the last call, where there is one: it is nearly sorted already
    const std::size_t index = same_count ? index_[k] : k;
    if (same_count && k + ahead < count)
      __builtin_prefetch(&problem.positions[index_[k + ahead]]);
    const Vec3 p = into_cell(problem.box, offset, problem.positions[index]);
    const std::size_t a = cell_of(p.x(), left, columns_per_metre, tiling.columns) / tiling.side;
    const std::size_t b = cell_of(p.y(), bottom, rows_per_metre, tiling.rows) / tiling.side;
    found_[k] = {p.x(), p.y(), p.z(), static_cast<std::uint32_t>(index)};
    tile_of_[k] = static_cast<std::uint32_t>(a * tiling.tile_rows() + b);
  });

  counting_sort(tile_of_, tiling.count(), first_,
                [&](std::size_t k, std::size_t place) { sorted_[place] = found_[k]; });

  for (auto* const numbers : {&x_, &y_, &z_})
    numbers->resize(count + NearSources::widest);
  mass_.resize(count + NearSources::widest);
  index_.resize(count);
  parallel_for(
      tiling.count(),
      [&](std::size_t t) {
        std::sort(sorted_.begin() + first_[t], sorted_.begin() + first_[t + 1], [&](const Place& a, const Place& b) {
          return a.z != b.z ? a.z < b.z : problem.ids[a.index] < problem.ids[b.index];
        });
      },
      16);
  const double mass = exact_sum(count, [&](std::size_t k) { return problem.masses[k]; });
  mass_unit_ = mass > 0.0 ? mass / static_cast<double>(count) : 1.0;
  parallel_for(count, [&](std::size_t k) {
    const Place& p = sorted_[k];
    x_[k] = p.x;
    y_[k] = p.y;
    z_[k] = p.z;
    mass_[k] = static_cast<float>(problem.masses[p.index] / mass_unit_);
    index_[k] = p.index;
  });
}

} // namespace keeler
