#include <keeler/gravity/tree.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/gravity/images.hpp>
#include <keeler/gravity/local_expansion.hpp>
#include <keeler/gravity/mean_sheet.hpp>
#include <keeler/gravity/single.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr std::size_t group_size = TargetBlock::capacity;

// Targets that share a walk: particles [begin, begin + count), all inside the box of a cell.
struct Group {
  std::uint32_t begin, count;
  const TreeCell* cell;
};

std::vector<Group> make_groups(const std::vector<TreeCell>& cells) {
  std::vector<Group> groups;
  for (std::size_t c = 0; c < cells.size();) {
    const TreeCell& cell = cells[c];
    if (cell.count > group_size && !cell.is_leaf()) {
      ++c;
      continue;
    }
    for (std::uint32_t done = 0; done < cell.count; done += group_size)
      groups.push_back({cell.begin + done, std::min<std::uint32_t>(group_size, cell.count - done), &cell});
    c += cell.span;
  }
  return groups;
}

// Squared distance of the group's box from the cell's centre of mass beyond which a cell need not be opened; infinite
// at angle 0. Cells closer than a micrometre are always opened: floats do not hold their fields.
std::vector<double> opening_distances(const std::vector<TreeCell>& cells, double opening_angle) {
  std::vector<double> squared(cells.size(), std::numeric_limits<double>::infinity());
  if (opening_angle > 0.0)
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double distance = std::max(cells[c].size / opening_angle, 1e-6);
      squared[c] = distance * distance;
    }
  return squared;
}

// A cell acts through the local expansion of a group when the sum of their radii is below this times the distance of
// their centres. The expansion's error then stays below that of opening_angle; 1 would be its limit of convergence.
double far_angle(double opening_angle) {
  return std::min(0.7 * opening_angle, 0.5);
}

std::vector<SinglePoint> single_points(const std::vector<TreeParticle>& particles, double total_mass) {
  std::vector<SinglePoint> points(particles.size());
  parallel_for(particles.size(), [&](std::size_t k) {
    const TreeParticle& p = particles[k];
    points[k] = single_point({p.x, p.y, p.z, p.mass / total_mass});
  });
  return points;
}

// Bodies that attract each other and their images exert no net force on themselves: what the tree's errors leave of
// one, their mean acceleration, is taken out.
void take_out_net_force(const std::vector<TreeParticle>& particles, double mass, std::vector<Vec3>& accelerations) {
  if (mass == 0.0)
    return;
  Vec3 mean;
  for (int axis = 0; axis < 3; ++axis)
    mean[axis] =
        ordered_sum(particles.size(), [&](std::size_t k) { return particles[k].mass * accelerations[k][axis]; }) / mass;
  parallel_for(particles.size(), [&](std::size_t k) { accelerations[k] -= mean; });
}

// What all walks share.
struct Sources {
  const CellTree& tree;
  const std::vector<SinglePoint>& points;
  const std::vector<double>& opening;
  const AttractionKernels& kernels;
  double far_angle;
  double total_mass;
};

// The walk of one group: gathers sources and hands them to the kernels whenever a list is full, so it needs no memory
// of its own and the order of the sums depends on the tree alone.
class Walk {
public:
  Walk(const Sources& sources, const Group& group)
      : from_(sources), group_(group), origin_(0.5 * (group.cell->low + group.cell->high)),
        radius_(0.5 * (group.cell->high - group.cell->low).norm()) {
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const TreeParticle& p = from_.tree.particles()[group.begin + k];
      targets_.from_x[k] = static_cast<float>(p.x - origin_.x());
      targets_.from_y[k] = static_cast<float>(p.y - origin_.y());
      targets_.from_z[k] = static_cast<float>(p.z - origin_.z());
      split_place(p.z, targets_.z[k], targets_.z_low[k]);
    }
  }

  // Adds what the image at this shift contributes.
  void add_image(const Vec3& shift) {
    const std::vector<TreeCell>& cells = from_.tree.cells();
    const Vec3 low = group_.cell->low - shift;
    const Vec3 high = group_.cell->high - shift;
    const Vec3 origin = origin_ - shift;
    range_count_ = 0;
    placed_ = false;
    for (std::size_t c = 0; c < cells.size();) {
      const TreeCell& cell = cells[c];
      const Vec3 gap = (low - cell.centre).cwiseMax(cell.centre - high).cwiseMax(0.0);
      const bool far = gap.squaredNorm() > from_.opening[c];
      const bool apart = (cell.high.array() < low.array()).any() || (high.array() < cell.low.array()).any();
      if (far && apart) {
        const Vec3 r = cell.centre - origin;
        if (r.norm() * from_.far_angle > radius_ + 0.5 * cell.size)
          add_far(cell, r);
        else
          add_cell(cell, r);
      } else if (cell.is_leaf())
        add_leaf(cell, shift);
      else {
        ++c;
        continue;
      }
      c += cell.span;
    }
    flush_points(shift);
  }

  const SingleTargetBlock& result() {
    flush_cells();
    flush_far();
    complete(terms_);
    from_.kernels.local(targets_, group_.count, terms_);
    return targets_;
  }

private:
  // The cell as a source at r from the group's centre.
  CellSource source(const TreeCell& cell, const Vec3& r) const {
    const double unit = 1.0 / from_.total_mass;
    const auto single = [](double value) { return static_cast<float>(value); };
    return {single(r.x()),
            single(r.y()),
            single(r.z()),
            single(unit * cell.mass),
            single(unit * cell.diagonal.x()),
            single(unit * cell.diagonal.y()),
            single(unit * cell.diagonal.z()),
            single(unit * cell.mixed.x()),
            single(unit * cell.mixed.y()),
            single(unit * cell.mixed.z())};
  }

  void add_cell(const TreeCell& cell, const Vec3& r) {
    cells_[cell_count_++] = source(cell, r);
    if (cell_count_ == cell_capacity)
      flush_cells();
  }

  void add_far(const TreeCell& cell, const Vec3& r) {
    put(far_, far_count_++, source(cell, r));
    if (far_count_ == FarCells::capacity)
      flush_far();
  }

  void add_leaf(const TreeCell& cell, const Vec3& shift) {
    if (range_count_ > 0 && ranges_[range_count_ - 1].begin + ranges_[range_count_ - 1].count == cell.begin) {
      ranges_[range_count_ - 1].count += cell.count;
      return;
    }
    if (range_count_ == range_capacity)
      flush_points(shift);
    ranges_[range_count_++] = {cell.begin, cell.count};
  }

  void flush_cells() {
    from_.kernels.cells(targets_, group_.count, cells_, cell_count_);
    cell_count_ = 0;
  }

  void flush_far() {
    for (; far_count_ % FarCells::lanes != 0; ++far_count_)
      put(far_, far_count_, {1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F});
    from_.kernels.far_cells(terms_, far_, far_count_);
    far_count_ = 0;
  }

  // An image at +shift attracts as the cell does a target at −shift.
  void flush_points(const Vec3& shift) {
    if (range_count_ == 0)
      return;
    if (!placed_)
      for (std::uint32_t k = 0; k < group_.count; ++k) {
        const TreeParticle& p = from_.tree.particles()[group_.begin + k];
        split_place(p.x - shift.x(), targets_.x[k], targets_.x_low[k]);
        split_place(p.y - shift.y(), targets_.y[k], targets_.y_low[k]);
      }
    placed_ = true;
    from_.kernels.points_single(targets_, group_.count, from_.points.data(), ranges_, range_count_);
    range_count_ = 0;
  }

  static constexpr std::size_t cell_capacity = 128;  // 10 kB
  static constexpr std::size_t range_capacity = 128; // 16 kB

  const Sources& from_;
  const Group& group_;
  Vec3 origin_;
  double radius_;
  bool placed_ = false;
  SingleTargetBlock targets_{};
  LocalTerms terms_{};
  std::size_t cell_count_ = 0, far_count_ = 0, range_count_ = 0;
  CellSource cells_[cell_capacity];
  FarCells far_;
  PointRange ranges_[range_capacity];
};

} // namespace

TreeSolver::TreeSolver(double opening_angle, int image_rings, InstructionSet set)
    : opening_angle_(opening_angle), image_rings_(image_rings), kernels_(attraction_kernels(set)) {}

void TreeSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const double offset = folded_offset(problem.box, problem.offset);
  const std::vector<Vec3> shifts = image_shifts(problem.box, offset, image_rings_);
  const std::size_t particle_count = problem.positions.size();
  std::vector<TreeParticle> particles(particle_count);
  const bool same_count = tree_.particles().size() == particle_count;
  parallel_for(particle_count, [&](std::size_t k) {
    // in the order of the last tree, where there is one: it is nearly sorted already
    const std::size_t index = same_count ? tree_.particles()[k].index : k;
    const Vec3 p = into_cell(problem.box, offset, problem.positions[index]);
    particles[k] = {p.x(), p.y(), p.z(), problem.masses[index], problem.ids[index], index};
  });
  tree_.build(std::move(particles));

  const std::vector<Group> groups = make_groups(tree_.cells());
  const std::vector<double> opening = opening_distances(tree_.cells(), opening_angle_);
  std::vector<Vec3> total = sheet_accelerations(problem, offset, image_rings_, tree_.particles());
  const double mass = ordered_sum(particle_count, [&](std::size_t k) { return tree_.particles()[k].mass; });
  const std::vector<SinglePoint> points = single_points(tree_.particles(), mass);
  const Sources sources{tree_, points, opening, kernels_, far_angle(opening_angle_), mass};
  parallel_for(
      groups.size(),
      [&](std::size_t g) {
        Walk walk(sources, groups[g]);
        for (const Vec3& shift : shifts)
          walk.add_image(shift);
        const SingleTargetBlock& sum = walk.result();
        for (std::uint32_t k = 0; k < groups[g].count; ++k) {
          total[groups[g].begin + k] += problem.newton_g * mass * Vec3(sum.ax[k], sum.ay[k], sum.az[k]);
        }
      },
      4);
  take_out_net_force(tree_.particles(), mass, total);
  parallel_for(particle_count, [&](std::size_t k) { accelerations[tree_.particles()[k].index] = total[k]; });
}

} // namespace keeler
