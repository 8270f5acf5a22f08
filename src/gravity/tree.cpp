#include <keeler/gravity/tree.hpp>

#include <keeler/core/threads.hpp>
#include <keeler/gravity/far_images.hpp>
#include <keeler/gravity/images.hpp>

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

// Squared distance from the group's centre of mass beyond which a cell need not be opened; infinite at angle 0.
std::vector<double> opening_distances(const std::vector<TreeCell>& cells, double opening_angle) {
  std::vector<double> squared(cells.size(), std::numeric_limits<double>::infinity());
  if (opening_angle > 0.0)
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double distance = cells[c].size / opening_angle;
      squared[c] = distance * distance;
    }
  return squared;
}

// The walk of one group: gathers sources and hands them to the kernels whenever a list is full, so it needs no memory
// of its own and the order of the sums depends on the tree alone.
class Walk {
public:
  Walk(const CellTree& tree, const std::vector<double>& opening, const AttractionKernels& kernels, const Group& group)
      : tree_(tree), opening_(opening), kernels_(kernels), group_(group) {
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const TreeParticle& p = tree.particles()[group.begin + k];
      targets_.x[k] = p.x;
      targets_.y[k] = p.y;
      targets_.z[k] = p.z;
    }
  }

  // Adds what the image at this shift contributes.
  void add_image(const Vec3& shift) {
    const std::vector<TreeCell>& cells = tree_.cells();
    const Vec3 low = group_.cell->low - shift;
    const Vec3 high = group_.cell->high - shift;
    for (std::size_t c = 0; c < cells.size();) {
      const TreeCell& cell = cells[c];
      const Vec3 gap = (low - cell.centre).cwiseMax(cell.centre - high).cwiseMax(0.0);
      const bool far = gap.squaredNorm() > opening_[c];
      const bool apart = (cell.high.array() < low.array()).any() || (high.array() < cell.low.array()).any();
      if (far && apart)
        add_cell(cell, shift);
      else if (cell.is_leaf())
        add_leaf(cell, shift);
      else {
        ++c;
        continue;
      }
      c += cell.span;
    }
  }

  const TargetBlock& result() {
    flush_cells();
    flush_points();
    return targets_;
  }

private:
  void add_cell(const TreeCell& cell, const Vec3& shift) {
    cells_[cell_count_++] = {
        cell.centre.x() + shift.x(), cell.centre.y() + shift.y(), cell.centre.z(), cell.mass,      cell.diagonal.x(),
        cell.diagonal.y(),           cell.diagonal.z(),           cell.mixed.x(),  cell.mixed.y(), cell.mixed.z()};
    if (cell_count_ == cell_capacity)
      flush_cells();
  }

  void add_leaf(const TreeCell& cell, const Vec3& shift) {
    for (std::uint32_t k = 0; k < cell.count; ++k) {
      const TreeParticle& p = tree_.particles()[cell.begin + k];
      points_[point_count_++] = {p.x + shift.x(), p.y + shift.y(), p.z, p.mass};
      if (point_count_ == point_capacity)
        flush_points();
    }
  }

  void flush_cells() {
    kernels_.cells(targets_, group_.count, cells_, cell_count_);
    cell_count_ = 0;
  }

  void flush_points() {
    kernels_.points(targets_, group_.count, points_, point_count_);
    point_count_ = 0;
  }

  static constexpr std::size_t cell_capacity = 128;  // 10 kB
  static constexpr std::size_t point_capacity = 512; // 16 kB

  const CellTree& tree_;
  const std::vector<double>& opening_;
  const AttractionKernels& kernels_;
  const Group& group_;
  TargetBlock targets_{};
  std::size_t cell_count_ = 0, point_count_ = 0;
  CellSource cells_[cell_capacity];
  PointSource points_[point_capacity];
};

} // namespace

TreeSolver::TreeSolver(double opening_angle, const ImageSettings& images, InstructionSet set)
    : opening_angle_(opening_angle), images_(images), set_(set), kernels_(attraction_kernels(set)) {}

void TreeSolver::accelerate(const GravityProblem& problem, std::span<Vec3> accelerations) {
  const double offset = folded_offset(problem.box, problem.offset);
  const std::vector<Vec3> shifts = near_images(problem.box, offset, images_);
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
  const std::vector<Vec3> from_far = far_accelerations<float>(problem, offset, images_, tree_.particles(), set_);
  parallel_for(
      groups.size(),
      [&](std::size_t g) {
        Walk walk(tree_, opening, kernels_, groups[g]);
        for (const Vec3& shift : shifts)
          walk.add_image(shift);
        const TargetBlock& sum = walk.result();
        for (std::uint32_t k = 0; k < groups[g].count; ++k) {
          const std::size_t p = groups[g].begin + k;
          accelerations[tree_.particles()[p].index] =
              problem.newton_g * Vec3(sum.ax[k], sum.ay[k], sum.az[k]) + from_far[p];
        }
      },
      4);
}

} // namespace keeler
