#include "sorted_particles.hpp"

#include "aligned_array.hpp"

#include <keeler/core/counting_sort.hpp>
#include <keeler/core/exact_sum.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::gravity {
namespace {

// The particles of a problem, at any position relative to the cell.
struct ProblemSource {
  const GravityProblem& problem;
  double offset;

  std::size_t count() const { return problem.positions.size(); }
  void prefetch(std::size_t k) const { __builtin_prefetch(&problem.positions[k]); }
  Vec3 position(std::size_t k) const { return into_cell(problem.box, offset, problem.positions[k]); }
  double mass(std::size_t k) const { return problem.masses[k]; }
  std::uint64_t id(std::size_t k) const { return problem.ids[k]; }
};

// Particles already folded into the cell.
struct FoldedSource {
  std::span<const FoldedParticle> particles;

  std::size_t count() const { return particles.size(); }
  void prefetch(std::size_t k) const { __builtin_prefetch(&particles[k]); }
  Vec3 position(std::size_t k) const { return {particles[k].x, particles[k].y, particles[k].z}; }
  double mass(std::size_t k) const { return particles[k].mass; }
  std::uint64_t id(std::size_t k) const { return particles[k].id; }
};

} // namespace

void SortedParticles::sort(const GravityProblem& problem, double offset, const Tiling& tiling) {
  const std::size_t count = problem.positions.size();
  assert(problem.masses.size() == count && problem.ids.size() == count);
  tiling_ = tiling;
  const double mass = exact_sum(count, [&](std::size_t k) { return problem.masses[k]; });
  mass_unit_ = mass > 0.0 ? mass / static_cast<double>(count) : 1.0;
  sort_source(ProblemSource{problem, offset}, problem.box, {0, tiling.tile_columns()});
}

void SortedParticles::sort(std::span<const FoldedParticle> particles, const ShearingBox& box, const Tiling& tiling,
                           const TileColumns& columns, double mass_unit) {
  assert(mass_unit > 0.0 && columns.count <= tiling.tile_columns());
  tiling_ = tiling;
  mass_unit_ = mass_unit;
  sort_source(FoldedSource{particles}, box, columns);
}

template<class Source>
void SortedParticles::sort_source(const Source& source, const ShearingBox& box, const TileColumns& columns) {
  const TileFinder find(tiling_, box);
  const std::size_t count = source.count(), tiles = columns.count * tiling_.tile_rows();
  const bool reuse_order = index_.size() == count;
  first_tile_ = columns.begin * tiling_.tile_rows();
  tiles_behind_ = tiling_.count() - first_tile_;
  constexpr std::size_t ahead = 24;
  AlignedArray<Entry> unsorted, sorted;
  AlignedArray<std::uint32_t> tile_of;
  unsorted.resize_at_least(count);
  tile_of.resize_at_least(count);
  parallel_for(count, [&](std::size_t k) {
    // in the order of the last call, if there is one: it is nearly sorted
    const std::size_t index = reuse_order ? index_[k] : k;
    if (reuse_order && k + ahead < count)
      source.prefetch(index_[k + ahead]);
    const Vec3 p = source.position(index);
    unsorted.data()[k] = {p.x(), p.y(), p.z(), static_cast<std::uint32_t>(index)};
    tile_of.data()[k] = static_cast<std::uint32_t>(local_tile(find.tile(p.x(), p.y())));
  });

  sorted.resize_at_least(count);
  counting_sort(std::span(tile_of.data(), count), tiles, first_,
                [&](std::size_t k, std::size_t position) { sorted.data()[position] = unsorted.data()[k]; });
  unsorted = {};
  tile_of = {};

  for (auto* const coordinates : {&x_, &y_, &z_})
    resize_scratch(*coordinates, count + NearSources::max_lanes);
  resize_scratch(mass_, count + NearSources::max_lanes);
  resize_scratch(index_, count);
  parallel_for(
      tiles,
      [&](std::size_t t) {
        std::sort(sorted.data() + first_[t], sorted.data() + first_[t + 1], [&](const Entry& a, const Entry& b) {
          return a.z != b.z ? a.z < b.z : source.id(a.index) < source.id(b.index);
        });
      },
      16);
  parallel_for(count, [&](std::size_t k) {
    const Entry& p = sorted.data()[k];
    x_[k] = p.x;
    y_[k] = p.y;
    z_[k] = p.z;
    mass_[k] = static_cast<float>(source.mass(p.index) / mass_unit_);
    index_[k] = p.index;
  });
}

void SortedParticles::release() {
  for (auto* const coordinates : {&x_, &y_, &z_})
    free_memory(*coordinates);
  free_memory(mass_);
}

} // namespace keeler::gravity
