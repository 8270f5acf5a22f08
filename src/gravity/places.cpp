#include "places.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>

namespace keeler {
namespace {

// Particles wherever they stand relative to the cell.
struct Anywhere {
  const GravityProblem& problem;
  double offset;

  std::size_t count() const { return problem.positions.size(); }
  void prefetch(std::size_t k) const { __builtin_prefetch(&problem.positions[k]); }
  Vec3 place(std::size_t k) const { return into_cell(problem.box, offset, problem.positions[k]); }
  double mass(std::size_t k) const { return problem.masses[k]; }
  std::uint64_t id(std::size_t k) const { return problem.ids[k]; }
};

struct Inside {
  std::span<const InsideParticle> particles;

  std::size_t count() const { return particles.size(); }
  void prefetch(std::size_t k) const { __builtin_prefetch(&particles[k]); }
  Vec3 place(std::size_t k) const { return {particles[k].x, particles[k].y, particles[k].z}; }
  double mass(std::size_t k) const { return particles[k].mass; }
  std::uint64_t id(std::size_t k) const { return particles[k].id; }
};

} // namespace

void Places::sort(const GravityProblem& problem, double offset, const Tiling& tiling) {
  const std::size_t count = problem.positions.size();
  tiling_ = tiling;
  const double mass = exact_sum(count, [&](std::size_t k) { return problem.masses[k]; });
  mass_unit_ = mass > 0.0 ? mass / static_cast<double>(count) : 1.0;
  put_in_order(Anywhere{problem, offset}, problem.box, {0, tiling.tile_columns()});
}

void Places::sort(std::span<const InsideParticle> particles, const ShearingBox& box, const Tiling& tiling,
                  const TileColumns& known, double mass_unit) {
  tiling_ = tiling;
  mass_unit_ = mass_unit;
  put_in_order(Inside{particles}, box, known);
}

template<class Source>
void Places::put_in_order(const Source& source, const ShearingBox& box, const TileColumns& known) {
  const TileFinder find(tiling_, box);
  const std::size_t count = source.count(), tiles = known.count * tiling_.tile_rows();
  const bool same_count = index_.size() == count;
  first_known_ = known.begin * tiling_.tile_rows();
  behind_ = tiling_.count() - first_known_;
  constexpr std::size_t ahead = 24;
  resize_scratch(found_, count);
  resize_scratch(tile_of_, count);
  resize_scratch(sorted_, count);
  parallel_for(count, [&](std::size_t k) {
    // in the order of the last call, where there is one: it is nearly sorted already
    const std::size_t index = same_count ? index_[k] : k;
    if (same_count && k + ahead < count)
      source.prefetch(index_[k + ahead]);
    const Vec3 p = source.place(index);
    found_[k] = {p.x(), p.y(), p.z(), static_cast<std::uint32_t>(index)};
    tile_of_[k] = static_cast<std::uint32_t>(local(find.tile(p.x(), p.y())));
  });

  counting_sort(tile_of_, tiles, first_, [&](std::size_t k, std::size_t place) { sorted_[place] = found_[k]; });

  for (auto* const numbers : {&x_, &y_, &z_})
    resize_scratch(*numbers, count + NearSources::widest);
  resize_scratch(mass_, count + NearSources::widest);
  resize_scratch(index_, count);
  parallel_for(
      tiles,
      [&](std::size_t t) {
        std::sort(sorted_.begin() + first_[t], sorted_.begin() + first_[t + 1], [&](const Place& a, const Place& b) {
          return a.z != b.z ? a.z < b.z : source.id(a.index) < source.id(b.index);
        });
      },
      16);
  parallel_for(count, [&](std::size_t k) {
    const Place& p = sorted_[k];
    x_[k] = p.x;
    y_[k] = p.y;
    z_[k] = p.z;
    mass_[k] = static_cast<float>(source.mass(p.index) / mass_unit_);
    index_[k] = p.index;
  });
}

} // namespace keeler
