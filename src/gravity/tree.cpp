#include "tree.hpp"

#include "far_images.hpp"
#include "gathered.hpp"
#include "local_expansion.hpp"
#include "single.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace keeler::gravity {
namespace {

constexpr std::uint32_t group_size = SingleTargetBlock::capacity;

// Targets of one walk: particles [begin, begin + count), all inside the box of a cell.
struct Group {
  std::uint32_t begin, count;
  std::uint32_t cell;
};

// Returns the groups, which partition the particles: the largest cells of at most group_size particles.
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

// A group takes a cell as a whole if the group's box is farther from the cell's centre of mass than
// max(size / opening angle, reach) + margin, and opens it otherwise. Beyond `reach` the two boxes cannot overlap.
struct OpeningRule {
  float inverse_angle; // infinite if every cell is to be opened
  float far_angle;     // see below
  float margin;

  float distance(const TreeCell& cell) const { return std::max(cell.size * inverse_angle, cell.reach) + margin; }
};

// A cell acts through the local expansion of a group if the sum of their radii is below far_angle times the distance of
// their centres. The expansion's error then stays below that of the opening angle; it converges for angles below 1. The
// margin bounds the rounding of positions to floats, and is at least a micrometre: closer than that, floats do not hold
// a cell's field.
OpeningRule opening_rule(double opening_angle, const CellBox& whole, const std::vector<Vec3>& shifts) {
  double farthest = 0.0;
  for (const Vec3& shift : shifts)
    for (int k = 0; k < 3; ++k)
      farthest = std::max({farthest, shift[k] - whole.low[k], shift[k] + whole.high[k]});
  return {opening_angle > 0.0 ? static_cast<float>(1.0 / opening_angle) : std::numeric_limits<float>::infinity(),
          static_cast<float>(std::min(0.7 * opening_angle, 0.5)), static_cast<float>(1e-6 + 1e-6 * farthest)};
}

// Mass of a group and the force on it.
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

// Four floats in one register, of which three are a position.
typedef float Four __attribute__((vector_size(16), may_alias));

inline float square3(const Four& v) {
  const Four squares = v * v;
  return squares[0] + squares[1] + squares[2];
}

// The box of a group, in single precision.
struct GroupBounds {
  explicit GroupBounds(const CellBox& box)
      : low{box.low[0], box.low[1], box.low[2], 0.0F}, high{box.high[0], box.high[1], box.high[2], 0.0F},
        centre(0.5F * (low + high)), radius(std::sqrt(square3(high - centre))) {}

  Four low, high, centre;
  float radius;
};

constexpr std::size_t list_capacity = 256;

// What a group sees of one image: emptied before each image. Full lists are handed on at once.
struct ImageLists {
  std::size_t near_count = 0, far_count = 0, range_count = 0;
  std::uint32_t near[list_capacity + 1], far[list_capacity + 1]; // cells that act as sources, or through the expansion
  PointRange ranges[list_capacity];                              // of particles in opened leaves
};

// Cells as sources relative to the group's centre, of one image after the other. Full lists go to the kernels.
struct GatheredCells {
  std::size_t near_count = 0, far_count = 0;
  CellSource near[list_capacity];
  FarCells far;
};

// The walk of one group: gathers sources and hands them to the kernels whenever a list is full. So it needs no dynamic
// memory, and the order of the sums depends on the tree alone. Call add_image() for each image, then result() once.
class Walk {
public:
  Walk(const CellTree& tree, const OpeningRule& rule, const AttractionKernels& kernels, const Group& group)
      : tree_(tree), rule_(rule), kernels_(kernels), group_(group), bounds_(tree.boxes()[group.cell]) {
    assert(group.count > 0 && group.count <= group_size && group.begin + group.count <= tree.points().size());
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const SinglePoint& p = tree.points()[group.begin + k];
      targets_.from_x[k] = (p.x - bounds_.centre[0]) + p.x_low;
      targets_.from_y[k] = (p.y - bounds_.centre[1]) + p.y_low;
      targets_.from_z[k] = (p.z - bounds_.centre[2]) + p.z_low;
      targets_.z[k] = p.z;
      targets_.z_low[k] = p.z_low;
    }
  }

  // Adds the attraction of the image at this shift.
  void add_image(const Vec3& shift) {
    find_sources(shift);
    gather_cells(shift);
    if (lists_.range_count > 0)
      flush_ranges(shift);
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
    const Four low = bounds_.low - moved, high = bounds_.high - moved, centre = bounds_.centre - moved;
    const float far2 = rule_.far_angle * rule_.far_angle;
    lists_.near_count = lists_.far_count = lists_.range_count = 0;
    for (std::uint32_t c = 0; c < cells.size();) {
      const TreeCell& cell = cells[c];
      const Four at = *reinterpret_cast<const Four*>(&cell);
      const Four below = low - at, above = at - high;
      const Four outside = below > above ? below : above;
      const Four gap = outside > Four{} ? outside : Four{};
      const float open = rule_.distance(cell);
      if (square3(gap) > open * open) {
        const float radii = bounds_.radius + 0.5F * cell.size;
        const bool far = square3(at - centre) * far2 > radii * radii;
        lists_.near[lists_.near_count] = c; // without a branch: written to both lists, and kept in one
        lists_.far[lists_.far_count] = c;
        lists_.near_count += !far;
        lists_.far_count += far;
        c += cell.span;
        if (lists_.near_count == list_capacity || lists_.far_count == list_capacity)
          gather_cells(shift);
      } else if (cell.is_leaf()) {
        add_range(cell, shift);
        ++c;
      } else
        ++c;
    }
  }

  void add_range(const TreeCell& cell, const Vec3& shift) {
    if (lists_.range_count > 0) {
      PointRange& last = lists_.ranges[lists_.range_count - 1];
      if (last.begin + last.count == cell.begin) {
        last.count += cell.count;
        return;
      }
    }
    if (lists_.range_count == list_capacity)
      flush_ranges(shift);
    lists_.ranges[lists_.range_count++] = {cell.begin, cell.count};
  }

  // Adds the attraction of the listed particles. An image at +shift attracts as the cell does a target at −shift.
  void flush_ranges(const Vec3& shift) {
    for (std::uint32_t k = 0; k < group_.count; ++k) {
      const PointSource& p = tree_.particles()[group_.begin + k];
      split_position(p.x - shift.x(), targets_.x[k], targets_.x_low[k]);
      split_position(p.y - shift.y(), targets_.y[k], targets_.y_low[k]);
    }
    kernels_.points_single(targets_, group_.count, tree_.points().data(), lists_.ranges, lists_.range_count);
    lists_.range_count = 0;
  }

  // Turns listed cells into sources relative to the group's centre.
  void gather_cells(const Vec3& shift) {
    float x, y, x_low, y_low;
    split_position(bounds_.centre[0] - shift.x(), x, x_low);
    split_position(bounds_.centre[1] - shift.y(), y, y_low);
    const float z = bounds_.centre[2];
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
    for (std::size_t k = 0; k < lists_.near_count; ++k) {
      gathered_.near[gathered_.near_count++] = source(lists_.near[k]);
      if (gathered_.near_count == list_capacity)
        flush_near();
    }
    for (std::size_t k = 0; k < lists_.far_count; ++k) {
      put(gathered_.far, gathered_.far_count++, source(lists_.far[k]));
      if (gathered_.far_count == FarCells::capacity)
        flush_far();
    }
    lists_.near_count = lists_.far_count = 0;
  }

  void flush_near() {
    kernels_.cells(targets_, group_.count, gathered_.near, gathered_.near_count);
    gathered_.near_count = 0;
  }

  void flush_far() {
    for (; gathered_.far_count % FarCells::lanes != 0; ++gathered_.far_count)
      put(gathered_.far, gathered_.far_count, {1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F});
    kernels_.far_cells(terms_, gathered_.far, gathered_.far_count);
    gathered_.far_count = 0;
  }

  const CellTree& tree_;
  const OpeningRule& rule_;
  const AttractionKernels& kernels_;
  const Group& group_;
  GroupBounds bounds_;
  SingleTargetBlock targets_{}; // and the sums so far
  LocalTerms terms_{};          // sums of the local expansion
  ImageLists lists_;
  GatheredCells gathered_;
};

} // namespace

TreeSolver::TreeSolver(double opening_angle, const ImageSettings& images, InstructionSet set)
    : opening_angle_(opening_angle), images_(images), set_(set), kernels_(attraction_kernels(set)) {
  assert(opening_angle >= 0.0);
}

TreeSolver::Part TreeSolver::solve(const GravityProblem& problem, const Communicator& ranks) {
  const std::size_t count = problem.positions.size();
  assert(count > 0 && problem.masses.size() == count && problem.ids.size() == count);
  const double offset = folded_offset(problem.box, problem.offset);
  if (tree_.order().size() == count) // neighbours are then close in memory
    indices_ = tree_.order();
  else {
    indices_.resize(count);
    std::iota(indices_.begin(), indices_.end(), 0U);
  }
  in_cell_.resize(count);
  parallel_for(count, [&](std::size_t k) {
    const std::uint32_t index = indices_[k];
    const Vec3 p = into_cell(problem.box, offset, problem.positions[index]);
    in_cell_[k] = {p.x(), p.y(), p.z(), problem.masses[index]};
  });
  tree_.build(in_cell_, indices_, problem.ids);
  const ImageSettings images = rings_for_height(images_, problem.box, height_of(in_cell_));
  const std::vector<Vec3> shifts = near_images(problem.box, offset, images);

  const std::vector<Group> groups = make_groups(tree_.cells());
  const OpeningRule rule = opening_rule(opening_angle_, tree_.boxes()[0], shifts);
  const double strength = problem.newton_g * tree_.mass_unit();
  Part part;
  for (std::size_t rank = 0; rank <= ranks.size(); ++rank) {
    const std::size_t group = groups.size() * rank / ranks.size();
    part.bounds.push_back(group < groups.size() ? groups[group].begin : count);
  }
  const std::size_t begin = part.bounds[ranks.rank()], end = part.bounds[ranks.rank() + 1];
  const std::size_t first_group = groups.size() * ranks.rank() / ranks.size();
  const std::span<const PointSource> targets = std::span(tree_.particles()).subspan(begin, end - begin);
  part.accelerations = far_accelerations<float>(problem, offset, images, tree_.particles(), targets, set_);
  std::vector<Momentum> gained(groups.size() * (ranks.rank() + 1) / ranks.size() - first_group);
  parallel_for(
      gained.size(),
      [&](std::size_t g) {
        const Group& group = groups[first_group + g];
        Walk walk(tree_, rule, kernels_, group);
        for (const Vec3& shift : shifts)
          walk.add_image(shift);
        const SingleTargetBlock& sum = walk.result();
        for (std::uint32_t k = 0; k < group.count; ++k) {
          Vec3& total = part.accelerations[group.begin + k - begin];
          total += strength * Vec3(sum.ax[k], sum.ay[k], sum.az[k]);
          gained[g].add(targets[group.begin + k - begin].mass, total);
        }
      },
      4);
  // Bodies that attract each other and their images exert no net force on themselves: the mean acceleration is the
  // tree's error, and is subtracted.
  const Vec3 mean = mean_acceleration(ranks.gather_on_all(std::span<const Momentum>(gained)));
  parallel_for(part.accelerations.size(), [&](std::size_t k) { part.accelerations[k] -= mean; });
  return part;
}

void TreeSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  assert(accelerations.size() == problem.positions.size());
  if constexpr (Communicator::possible)
    if (problem.ranks.distributed())
      return accelerate_distributed(problem, accelerations);
  if (problem.positions.empty())
    return;
  const Part part = solve(problem, {});
  parallel_for(accelerations.size(), [&](std::size_t k) { accelerations[tree_.order()[k]] = part.accelerations[k]; });
}

// Each rank builds the whole tree and walks it for a part of the groups, then returns accelerations to the owners.
void TreeSolver::accelerate_distributed(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const Communicator& ranks = problem.ranks;
  const GatheredParticles all(problem);
  if (all.problem().positions.empty())
    return;
  const Part part = solve(all.problem(), ranks);
  const std::vector<std::size_t>& first = all.first_of_rank();
  const auto owner_at = [&](std::size_t place) { // in the tree's order
    return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), tree_.order()[place]) -
                                    first.begin()) -
           1;
  };
  std::vector<std::vector<Vec3>> sent(ranks.size());
  for (std::size_t k = 0; k < part.accelerations.size(); ++k)
    sent[owner_at(part.bounds[ranks.rank()] + k)].push_back(part.accelerations[k]);
  const std::vector<std::vector<Vec3>> received = ranks.exchange(sent);
  for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
    std::size_t next = 0;
    for (std::size_t place = part.bounds[rank]; place < part.bounds[rank + 1]; ++place)
      if (owner_at(place) == ranks.rank())
        accelerations[tree_.order()[place] - first[ranks.rank()]] = received[rank][next++];
    assert(next == received[rank].size());
  }
}

} // namespace keeler::gravity
