#include "cell_tree.hpp"

#include "single.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/vector.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>

namespace keeler::gravity {
namespace {

// The position and index of a particle, sorted in place of it while the tree is built.
struct Key {
  float position[3];
  std::uint32_t index;
};

CellBox tight_box(const Key* first, const Key* last) {
  // all four words at once; the last one is not used. Two boxes in turns shorten the chain of dependencies
  typedef float Four __attribute__((vector_size(16), may_alias));
  const auto at = [](const Key* m) -> const Four& { return *reinterpret_cast<const Four*>(m); };
  Four low = at(first), high = low, other_low = at(last - 1), other_high = other_low;
  const Key* m = first;
  for (; m + 1 < last; m += 2) {
    const Four &a = at(m), &b = at(m + 1);
    low = a < low ? a : low;
    high = a > high ? a : high;
    other_low = b < other_low ? b : other_low;
    other_high = b > other_high ? b : other_high;
  }
  low = other_low < low ? other_low : low;
  high = other_high > high ? other_high : high;
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

// Moments of a subtree about its centre of mass.
struct Moments {
  double mass = 0.0;
  Vec3 centre = Vec3::Zero();
  Vec3 diagonal = Vec3::Zero(); // xx, yy, zz
  Vec3 mixed = Vec3::Zero();    // xy, xz, yz
};

// Adds the quadrupole of a mass at displacement d from the centre.
void add_quadrupole(Moments& moments, double mass, const Vec3& d) {
  moments.diagonal += mass * (3.0 * d.cwiseProduct(d) - Vec3::Constant(d.squaredNorm()));
  moments.mixed += 3.0 * mass * Vec3(d.x() * d.y(), d.x() * d.z(), d.y() * d.z());
}

Vec3 centre_of(double mass, const Vec3& sum, const CellBox& box) {
  if (mass > 0.0)
    return sum / mass;
  return 0.5 * (Vec3(box.low[0], box.low[1], box.low[2]) + Vec3(box.high[0], box.high[1], box.high[2]));
}

Moments moments_of(const PointSource* first, const PointSource* last, const CellBox& box) {
  Moments moments;
  Vec3 sum = Vec3::Zero();
  for (const PointSource* p = first; p != last; ++p) {
    moments.mass += p->mass;
    sum += p->mass * Vec3(p->x, p->y, p->z);
  }
  moments.centre = centre_of(moments.mass, sum, box);
  for (const PointSource* p = first; p != last; ++p)
    add_quadrupole(moments, p->mass, Vec3(p->x, p->y, p->z) - moments.centre);
  return moments;
}

Moments merged(const Moments& a, const Moments& b, const CellBox& box) {
  Moments moments;
  moments.mass = a.mass + b.mass;
  moments.centre = centre_of(moments.mass, a.mass * a.centre + b.mass * b.centre, box);
  moments.diagonal = a.diagonal + b.diagonal;
  moments.mixed = a.mixed + b.mixed;
  add_quadrupole(moments, a.mass, a.centre - moments.centre);
  add_quadrupole(moments, b.mass, b.centre - moments.centre);
  return moments;
}

// Consecutive cells with their boxes and moments.
struct Cells {
  std::vector<TreeCell> cells;
  std::vector<CellBox> boxes;
  std::vector<CellMoments> moments;

  void reserve(std::size_t count) {
    cells.reserve(count);
    boxes.reserve(count);
    moments.reserve(count);
  }

  void append(const Cells& others) {
    cells.insert(cells.end(), others.cells.begin(), others.cells.end());
    boxes.insert(boxes.end(), others.boxes.begin(), others.boxes.end());
    moments.insert(moments.end(), others.moments.begin(), others.moments.end());
  }
};

// Builds subtrees and writes the particles of their leaves to the tree's arrays.
class SubtreeBuilder {
public:
  SubtreeBuilder(std::span<const PointSource> input, std::span<const std::uint32_t> indices,
                 std::span<const std::uint64_t> ids, double mass_unit, PointSource* particles, std::uint32_t* order,
                 SinglePoint* points)
      : input_(input), indices_(indices), ids_(ids), mass_unit_(mass_unit), particles_(particles), order_(order),
        points_(points) {}

  // Appends the subtree over keys [begin, end). The keys are in `here`; `there` is a buffer of equal length, which
  // partitions write to. Precondition: begin < end.
  Moments build(Cells& to, Key* here, Key* there, std::uint32_t begin, std::uint32_t end, int depth) const {
    assert(begin < end);
    const CellBox box = tight_box(here + begin, here + end);
    const std::size_t cell = open(to, begin, end - begin, box);
    Moments moments;
    const std::uint32_t middle =
        depth < CellTree::max_depth && end - begin > CellTree::leaf_size ? split(box, here, there, begin, end) : begin;
    if (middle > begin && middle < end) {
      const Moments a = build(to, there, here, begin, middle, depth + 1);
      const Moments b = build(to, there, here, middle, end, depth + 1);
      moments = merged(a, b, box);
    } else {
      write_leaf(here, begin, end);
      moments = moments_of(particles_ + begin, particles_ + end, box);
    }
    close(to, cell, moments);
    return moments;
  }

  // Partitions keys [begin, end) from `here` to `there`, the lower half of the box first. Returns the end of the
  // lower half.
  static std::uint32_t split(const CellBox& box, const Key* here, Key* there, std::uint32_t begin, std::uint32_t end) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis])
        axis = k;
    float middle = 0.5F * (box.low[axis] + box.high[axis]);
    if (!(middle < box.high[axis])) // neighbouring floats
      middle = box.low[axis];
    std::uint32_t left = begin, right = end;
    for (const Key* m = here + begin; m != here + end; ++m) { // without branches: written to both ends, and kept at one
      const bool low = m->position[axis] <= middle;
      there[left] = *m;
      there[right - 1] = *m;
      left += low;
      right -= !low;
    }
    return left;
  }

  static std::size_t open(Cells& to, std::uint32_t begin, std::uint32_t count, const CellBox& box) {
    float size = 0.0F;
    for (int k = 0; k < 3; ++k)
      size = std::max(size, box.high[k] - box.low[k]);
    to.cells.push_back({0.0F, 0.0F, 0.0F, size, 0.0F, begin, count, 1});
    to.boxes.push_back(box);
    to.moments.push_back({});
    return to.cells.size() - 1;
  }

  // Writes span and moments of a cell. Precondition: its subtree is complete and ends the cells.
  void close(Cells& to, std::size_t index, const Moments& from) const {
    assert(index < to.cells.size());
    TreeCell& cell = to.cells[index];
    CellMoments& moments = to.moments[index];
    const CellBox& box = to.boxes[index];
    cell.span = static_cast<std::uint32_t>(to.cells.size() - index);
    split_position(from.centre.x(), cell.x, moments.x_low);
    split_position(from.centre.y(), cell.y, moments.y_low);
    split_position(from.centre.z(), cell.z, moments.z_low);
    const float dx = std::max(cell.x - box.low[0], box.high[0] - cell.x);
    const float dy = std::max(cell.y - box.low[1], box.high[1] - cell.y);
    const float dz = std::max(cell.z - box.low[2], box.high[2] - cell.z);
    cell.reach = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double unit = 1.0 / mass_unit_;
    moments.mass = static_cast<float>(unit * from.mass);
    moments.xx = static_cast<float>(unit * from.diagonal.x());
    moments.yy = static_cast<float>(unit * from.diagonal.y());
    moments.zz = static_cast<float>(unit * from.diagonal.z());
    moments.xy = static_cast<float>(unit * from.mixed.x());
    moments.xz = static_cast<float>(unit * from.mixed.y());
    moments.yz = static_cast<float>(unit * from.mixed.z());
  }

private:
  // Sorts the keys of a leaf and writes its particles.
  void write_leaf(Key* keys, std::uint32_t begin, std::uint32_t end) const {
    const auto before = [this](const Key& a, const Key& b) {
      return a.position[0] != b.position[0] ? a.position[0] < b.position[0]
                                            : ids_[indices_[a.index]] < ids_[indices_[b.index]];
    };
    for (std::uint32_t k = begin + 1; k < end && end - begin <= 32; ++k) // few keys: insertion sort
      for (std::uint32_t j = k; j > begin && before(keys[j], keys[j - 1]); --j)
        std::swap(keys[j], keys[j - 1]);
    if (end - begin > 32)
      std::sort(keys + begin, keys + end, before);
    const double unit = 1.0 / mass_unit_;
    for (std::uint32_t k = begin; k < end; ++k) {
      const PointSource& p = input_[keys[k].index];
      order_[k] = indices_[keys[k].index];
      particles_[k] = p;
      points_[k] = single_point({p.x, p.y, p.z, unit * p.mass});
    }
  }

  std::span<const PointSource> input_;
  std::span<const std::uint32_t> indices_;
  std::span<const std::uint64_t> ids_;
  double mass_unit_;
  PointSource* particles_;
  std::uint32_t* order_;
  SinglePoint* points_;
};

// A subtree that one thread builds.
struct Piece {
  std::uint32_t begin, end;
  int depth;
  bool swapped; // the keys are in the second buffer
  Cells cells = {};
  Moments moments = {};
};

// Splits the top of the tree into pieces of at most `largest` particles, left to right.
void split_top(std::vector<Piece>& pieces, Key* here, Key* there, std::uint32_t begin, std::uint32_t end, int depth,
               std::uint32_t largest) {
  if (end - begin > std::max(largest, CellTree::leaf_size) && depth < CellTree::max_depth) {
    const std::uint32_t middle = SubtreeBuilder::split(tight_box(here + begin, here + end), here, there, begin, end);
    if (middle > begin && middle < end) {
      split_top(pieces, there, here, begin, middle, depth + 1, largest);
      split_top(pieces, there, here, middle, end, depth + 1, largest);
      return;
    }
  }
  pieces.push_back({begin, end, depth, depth % 2 == 1});
}

CellBox enclosing(const CellBox& a, const CellBox& b) {
  CellBox box = a;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(a.low[k], b.low[k]);
    box.high[k] = std::max(a.high[k], b.high[k]);
  }
  return box;
}

// Appends the subtree that begins with piece `next` at this depth and advances `next` behind it. The depths of the
// pieces, left to right, define the shape of the binary tree.
Moments join(const SubtreeBuilder& builder, Cells& to, std::vector<Piece>::const_iterator& next, int depth) {
  if (next->depth == depth) {
    to.append(next->cells);
    return (next++)->moments;
  }
  const std::uint32_t begin = next->begin;
  const std::size_t here = SubtreeBuilder::open(to, begin, 0, {});
  const Moments a = join(builder, to, next, depth + 1);
  const std::size_t second = to.cells.size();
  const Moments b = join(builder, to, next, depth + 1);
  const CellBox box = enclosing(to.boxes[here + 1], to.boxes[second]);
  to.boxes[here] = box;
  TreeCell& cell = to.cells[here];
  cell.count = to.cells[here + 1].count + to.cells[second].count;
  for (int k = 0; k < 3; ++k)
    cell.size = std::max(cell.size, box.high[k] - box.low[k]);
  const Moments moments = merged(a, b, box);
  builder.close(to, here, moments);
  return moments;
}

} // namespace

void CellTree::build(std::span<const PointSource> particles, std::span<const std::uint32_t> indices,
                     std::span<const std::uint64_t> ids) {
  const std::size_t count = particles.size();
  assert(indices.size() == count && count <= std::numeric_limits<std::uint32_t>::max());
  particles_.resize(count);
  order_.resize(count);
  points_.resize(count);
  Cells all{std::move(cells_), std::move(boxes_), std::move(moments_)};
  all.cells.clear();
  all.boxes.clear();
  all.moments.clear();
  if (count > 0) {
    const auto keys = std::make_unique_for_overwrite<Key[]>(count),
               others = std::make_unique_for_overwrite<Key[]>(count);
    parallel_for(count, [&](std::size_t k) {
      const PointSource& p = particles[k];
      keys[k] = {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                 static_cast<std::uint32_t>(k)};
    });
    mass_unit_ = 0.0;
    for (const PointSource& p : particles)
      mass_unit_ = std::max(mass_unit_, p.mass);
    if (mass_unit_ == 0.0)
      mass_unit_ = 1.0;
    // any bound gives the same tree; this one makes enough pieces for the threads and enough work per piece
    const auto largest = static_cast<std::uint32_t>(std::max<std::size_t>(512, count / 64));
    std::vector<Piece> pieces;
    split_top(pieces, keys.get(), others.get(), 0, static_cast<std::uint32_t>(count), 0, largest);
    const SubtreeBuilder builder(particles, indices, ids, mass_unit_, particles_.data(), order_.data(), points_.data());
    parallel_for(
        pieces.size(),
        [&](std::size_t k) {
          Piece& piece = pieces[k];
          Key* const here = piece.swapped ? others.get() : keys.get();
          Key* const there = piece.swapped ? keys.get() : others.get();
          piece.cells.reserve((piece.end - piece.begin) / 2); // leaves are half full on average
          piece.moments = builder.build(piece.cells, here, there, piece.begin, piece.end, piece.depth);
        },
        1);
    auto next = pieces.cbegin();
    join(builder, all, next, 0);
    assert(next == pieces.cend() && all.cells[0].span == all.cells.size() && all.cells[0].count == count);
  }
  cells_ = std::move(all.cells);
  boxes_ = std::move(all.boxes);
  moments_ = std::move(all.moments);
}

} // namespace keeler::gravity
