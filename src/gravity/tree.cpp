#include "tree.hpp"

#include "far_images.hpp"
#include "local_expansion.hpp"
#include "single.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keeler {
namespace {

constexpr std::uint32_t group_size = SingleTargetBlock::capacity;

// Targets that share a walk: particles [begin, begin + count), all inside the box of a cell.
struct Group {
  std::uint32_t begin, count;
  std::uint32_t cell;
};

std::vector<Group> make_groups(const std::vector<TreeCell>& cells) {
  std::vector<Group> groups;
  for (std::uint32_t c = 0; c < cells.size();) {
    const TreeCell& cell = cells[c];
    if (cell.count > group_size && !cell.is_leaf()) {
      ++c;
      continue;
    }
    for (std::uint32_t done = 0; done < cell.count; done += group_size)
      groups.push_back({cell.begin + done, std::min(group_size, cell.count - done), c});
    c += cell.span;
  }
  return groups;
}

// When a group opens a cell. The group's box must be farther from its centre of mass than
// max(size / opening angle, reach) + margin; beyond `reach` the two boxes cannot overlap.
struct OpeningRule {
  float inverse_angle; // infinite where every cell is to be opened
  float far_angle;     // see below
  float margin;

  float distance(const TreeCell& cell) const { return std::max(cell.size * inverse_angle, cell.reach) + margin; }
};

// A cell acts through the local expansion of a group when the sum of their radii is below far_angle times the distance
// of their centres. The expansion's error then stays below that of the opening angle; 1 would be its limit of
// convergence. The margin is what floats may lose of a place, and at least a micrometre: closer than that, floats do
// not hold a cell's field.
OpeningRule opening_rule(double opening_angle, const CellBox& whole, const std::vector<Vec3>& shifts) {
  double farthest = 0.0;
  for (const Vec3& shift : shifts)
    for (int k = 0; k < 3; ++k)
      farthest = std::max({farthest, shift[k] - whole.low[k], shift[k] + whole.high[k]});
  return {opening_angle > 0.0 ? static_cast<float>(1.0 / opening_angle) : std::numeric_limits<float>::infinity(),
          static_cast<float>(std::min(0.7 * opening_angle, 0.5)), static_cast<float>(1e-6 + 1e-6 * farthest)};
}

// What a group gains per unit of time.
struct Momentum {
  double mass = 0.0;
  Vec3 force = Vec3::Zero();

  void add(double m, const Vec3& acceleration) {
    mass += m;
    force += m * acceleration;
  }
};

Vec3 mean_acceleration(const std::vector<Momentum>& groups) {
  Momentum all;
  for (const Momentum& group : groups) {
    all.mass += group.mass;
    all.force += group.force;
  }
  return all.mass > 0.0 ? Vec3(all.force / all.mass) : Vec3::Zero();
}

// Four floats at once, of which three are a place.
typedef float Four __attribute__((vector_size(16), may_alias));

inline float square3(const Four& v) {
  const Four squares = v * v;
  return squares[0] + squares[1] + squares[2];
}

// The walk of one group: gathers sources and hands them to the kernels whenever a list is full, so it needs no memory
// of its own and the order of the sums depends on the tree alone.
class Walk {
public:
  Walk(const CellTree& tree, const OpeningRule& rule, const AttractionKernels& kernels, const Group& group)
      : tree_(tree), rule_(rule), kernels_(kernels), group_(group) {
    const CellBox& box = tree.boxes()[group.cell];
    low_ = Four{box.low[0], box.low[1], box.low[2], 0.0F};
    high_ = Four{box.high[0], box.high[1], box.high[2], 0.0F};
    origin_ = 0.5F * (low_ + high_);
    radius_ = std::sqrt(square3(high_ - origin_));
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const SinglePoint& p = tree.points()[group.begin + k];
      targets_.from_x[k] = (p.x - origin_[0]) + p.x_low;
      targets_.from_y[k] = (p.y - origin_[1]) + p.y_low;
      targets_.from_z[k] = (p.z - origin_[2]) + p.z_low;
      targets_.z[k] = p.z;
      targets_.z_low[k] = p.z_low;
    }
  }

  // Adds what the image at this shift contributes.
  void add_image(const Vec3& shift) {
    find_sources(shift);
    gather_cells(shift);
    if (range_count_ > 0) {
      place_targets(shift);
      kernels_.points_single(targets_, group_.count, tree_.points().data(), ranges_, range_count_);
    }
  }

  const SingleTargetBlock& result() {
    flush_near();
    flush_far();
    complete(terms_);
    kernels_.local(targets_, group_.count, terms_);
    return targets_;
  }

private:
  // Lists the cells and the runs of particles that the group sees of an image.
  void find_sources(const Vec3& shift) {
    const std::vector<TreeCell>& cells = tree_.cells();
    const Four moved = {static_cast<float>(shift.x()), static_cast<float>(shift.y()), 0.0F, 0.0F};
    const Four low = low_ - moved, high = high_ - moved, origin = origin_ - moved;
    const float far2 = rule_.far_angle * rule_.far_angle;
    near_count_ = far_count_ = range_count_ = 0;
    for (std::uint32_t c = 0; c < cells.size();) {
      const TreeCell& cell = cells[c];
      const Four at = *reinterpret_cast<const Four*>(&cell);
      const Four below = low - at, above = at - high;
      const Four outside = below > above ? below : above;
      const Four gap = outside > Four{} ? outside : Four{};
      const float open = rule_.distance(cell);
      if (square3(gap) > open * open) {
        const float radii = radius_ + 0.5F * cell.size;
        const bool far = square3(at - origin) * far2 > radii * radii;
        near_[near_count_] = c; // both places, one of them to stay
        far_[far_count_] = c;
        near_count_ += !far;
        far_count_ += far;
        c += cell.span;
        if (near_count_ == list_capacity || far_count_ == list_capacity)
          gather_cells(shift);
      } else if (cell.is_leaf()) {
        add_range(cell, shift);
        ++c;
      } else
        ++c;
    }
  }

  void add_range(const TreeCell& cell, const Vec3& shift) {
    if (range_count_ > 0) {
      PointRange& last = ranges_[range_count_ - 1];
      if (last.begin + last.count == cell.begin) {
        last.count += cell.count;
        return;
      }
    }
    if (range_count_ == list_capacity) {
      place_targets(shift);
      kernels_.points_single(targets_, group_.count, tree_.points().data(), ranges_, range_count_);
      range_count_ = 0;
    }
    ranges_[range_count_++] = {cell.begin, cell.count};
  }

  // An image at +shift attracts as the cell does a target at −shift.
  void place_targets(const Vec3& shift) {
    for (std::uint32_t k = 0; k < group_.count; ++k) {
      const PointSource& p = tree_.particles()[group_.begin + k];
      split_place(p.x - shift.x(), targets_.x[k], targets_.x_low[k]);
      split_place(p.y - shift.y(), targets_.y[k], targets_.y_low[k]);
    }
  }

  // Turns listed cells into sources relative to the group's centre.
  void gather_cells(const Vec3& shift) {
    float x, y, x_low, y_low;
    split_place(origin_[0] - shift.x(), x, x_low);
    split_place(origin_[1] - shift.y(), y, y_low);
    const float z = origin_[2];
    const auto source = [&](std::uint32_t c) -> CellSource {
      const TreeCell& cell = tree_.cells()[c];
      const CellMoments& m = tree_.moments()[c];
      return {(cell.x - x) + (m.x_low - x_low),
              (cell.y - y) + (m.y_low - y_low),
              (cell.z - z) + m.z_low,
              m.mass,
              m.xx,
              m.yy,
              m.zz,
              m.xy,
              m.xz,
              m.yz};
    };
    for (std::size_t k = 0; k < near_count_; ++k) {
      near_sources_[near_gathered_++] = source(near_[k]);
      if (near_gathered_ == list_capacity)
        flush_near();
    }
    for (std::size_t k = 0; k < far_count_; ++k) {
      put(far_sources_, far_gathered_++, source(far_[k]));
      if (far_gathered_ == FarCells::capacity)
        flush_far();
    }
    near_count_ = far_count_ = 0;
  }

  void flush_near() {
    kernels_.cells(targets_, group_.count, near_sources_, near_gathered_);
    near_gathered_ = 0;
  }

  void flush_far() {
    for (; far_gathered_ % FarCells::lanes != 0; ++far_gathered_)
      put(far_sources_, far_gathered_, {1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F});
    kernels_.far_cells(terms_, far_sources_, far_gathered_);
    far_gathered_ = 0;
  }

  static constexpr std::size_t list_capacity = 256;

  const CellTree& tree_;
  const OpeningRule& rule_;
  const AttractionKernels& kernels_;
  const Group& group_;
  Four low_, high_; // the group's box
  Four origin_;     // its centre
  float radius_;
  SingleTargetBlock targets_{};
  LocalTerms terms_{};
  std::size_t near_count_ = 0, far_count_ = 0, range_count_ = 0, near_gathered_ = 0, far_gathered_ = 0;
  std::uint32_t near_[list_capacity + 1], far_[list_capacity + 1];
  PointRange ranges_[list_capacity];
  CellSource near_sources_[list_capacity];
  FarCells far_sources_;
};

} // namespace

TreeSolver::TreeSolver(double opening_angle, const ImageSettings& images, InstructionSet set)
    : opening_angle_(opening_angle), images_(images), set_(set), kernels_(attraction_kernels(set)) {}

void TreeSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const std::size_t count = problem.positions.size();
  if (count == 0)
    return;
  const double offset = folded_offset(problem.box, problem.offset);
  if (tree_.order().size() == count) // neighbours then stand together in memory
    places_ = tree_.order();
  else {
    places_.resize(count);
    std::iota(places_.begin(), places_.end(), 0U);
  }
  in_cell_.resize(count);
  parallel_for(count, [&](std::size_t k) {
    const std::uint32_t index = places_[k];
    const Vec3 p = into_cell(problem.box, offset, problem.positions[index]);
    in_cell_[k] = {p.x(), p.y(), p.z(), problem.masses[index]};
  });
  tree_.build(in_cell_, places_, problem.ids);
  const ImageSettings images = rings_for_height(images_, problem.box, height_of(in_cell_));
  const std::vector<Vec3> shifts = near_images(problem.box, offset, images);

  const std::vector<Group> groups = make_groups(tree_.cells());
  const OpeningRule rule = opening_rule(opening_angle_, tree_.boxes()[0], shifts);
  const double strength = problem.newton_g * tree_.mass_unit();
  std::vector<Vec3> total = far_accelerations<float>(problem, offset, images, tree_.particles(), set_);
  std::vector<Momentum> gained(groups.size());
  parallel_for(
      groups.size(),
      [&](std::size_t g) {
        Walk walk(tree_, rule, kernels_, groups[g]);
        for (const Vec3& shift : shifts)
          walk.add_image(shift);
        const SingleTargetBlock& sum = walk.result();
        for (std::uint32_t k = 0; k < groups[g].count; ++k) {
          const std::size_t p = groups[g].begin + k;
          total[p] += strength * Vec3(sum.ax[k], sum.ay[k], sum.az[k]);
          gained[g].add(tree_.particles()[p].mass, total[p]);
        }
      },
      4);
  // Bodies that attract each other and their images exert no net force on themselves: what the tree's errors leave of
  // one, their mean acceleration, is taken out.
  const Vec3 mean = mean_acceleration(gained);
  parallel_for(count, [&](std::size_t k) { accelerations[tree_.order()[k]] = total[k] - mean; });
}

} // namespace keeler
