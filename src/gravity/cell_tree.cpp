#include <keeler/gravity/cell_tree.hpp>

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

struct Box {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

Vec3 place(const TreeParticle& p) {
  return {p.x, p.y, p.z};
}

Box tight_box(const TreeParticle* first, const TreeParticle* last) {
  Box box{place(*first), place(*first)};
  for (const TreeParticle* p = first + 1; p != last; ++p) {
    box.low = box.low.cwiseMin(place(*p));
    box.high = box.high.cwiseMax(place(*p));
  }
  return box;
}

bool must_split(const Box& box, std::size_t count, int depth) {
  return count > CellTree::leaf_size && depth < CellTree::deepest && box.low != box.high;
}

// Moves the particles of the lower half to the front; both halves hold at least one.
TreeParticle* split(const Box& box, TreeParticle* first, TreeParticle* last) {
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  double middle = 0.5 * (box.low[axis] + box.high[axis]);
  if (!(middle < box.high[axis])) // neighbouring doubles
    middle = box.low[axis];
  double TreeParticle::*const along[] = {&TreeParticle::x, &TreeParticle::y, &TreeParticle::z};
  return std::partition(first, last, [=](const TreeParticle& p) { return p.*along[axis] <= middle; });
}

// Adds the quadrupole of a mass at a displacement d from the centre.
void add_quadrupole(TreeCell& cell, double mass, const Vec3& d) {
  cell.diagonal += mass * (3.0 * d.cwiseProduct(d) - Vec3::Constant(d.squaredNorm()));
  cell.mixed += 3.0 * mass * Vec3(d.x() * d.y(), d.x() * d.z(), d.y() * d.z());
}

// A cell with its box and range; the moments come later.
TreeCell bare_cell(const Box& box, std::size_t begin, std::size_t count) {
  TreeCell cell;
  cell.low = box.low;
  cell.high = box.high;
  cell.size = (box.high - box.low).maxCoeff();
  cell.begin = static_cast<std::uint32_t>(begin);
  cell.count = static_cast<std::uint32_t>(count);
  return cell;
}

void sum_particles(TreeCell& cell, const TreeParticle* particles) {
  for (std::uint32_t k = 0; k < cell.count; ++k) {
    cell.mass += particles[k].mass;
    cell.centre += particles[k].mass * place(particles[k]);
  }
  cell.centre = cell.mass > 0.0 ? Vec3(cell.centre / cell.mass) : Vec3(0.5 * (cell.low + cell.high));
  for (std::uint32_t k = 0; k < cell.count; ++k)
    add_quadrupole(cell, particles[k].mass, place(particles[k]) - cell.centre);
}

void sum_children(TreeCell& cell, const TreeCell& a, const TreeCell& b) {
  cell.mass = a.mass + b.mass;
  cell.centre =
      cell.mass > 0.0 ? Vec3((a.mass * a.centre + b.mass * b.centre) / cell.mass) : Vec3(0.5 * (cell.low + cell.high));
  cell.diagonal = a.diagonal + b.diagonal;
  cell.mixed = a.mixed + b.mixed;
  add_quadrupole(cell, a.mass, a.centre - cell.centre);
  add_quadrupole(cell, b.mass, b.centre - cell.centre);
}

// Closes the cell at `parent`, whose two subtrees are all that follows it.
void close(std::vector<TreeCell>& cells, std::size_t parent) {
  TreeCell& cell = cells[parent];
  const TreeCell& a = cells[parent + 1];
  const TreeCell& b = cells[parent + 1 + a.span];
  cell.span = static_cast<std::uint32_t>(cells.size() - parent);
  sum_children(cell, a, b);
}

// Appends the subtree over particles [begin, end).
void grow(std::vector<TreeCell>& cells, TreeParticle* all, std::size_t begin, std::size_t end, int depth) {
  const Box box = tight_box(all + begin, all + end);
  const std::size_t here = cells.size();
  cells.push_back(bare_cell(box, begin, end - begin));
  if (must_split(box, end - begin, depth)) {
    const auto middle = static_cast<std::size_t>(split(box, all + begin, all + end) - all);
    grow(cells, all, begin, middle, depth + 1);
    grow(cells, all, middle, end, depth + 1);
    close(cells, here);
  } else {
    std::sort(all + begin, all + end, [](const TreeParticle& a, const TreeParticle& b) { return a.id < b.id; });
    sum_particles(cells[here], all + begin);
  }
}

// A subtree that one thread grows.
struct Piece {
  std::size_t begin, end;
  int depth;
  std::vector<TreeCell> cells;
};

// Splits the top of the tree down to pieces of at most `largest` particles, left to right.
void cut(std::vector<Piece>& pieces, TreeParticle* all, std::size_t begin, std::size_t end, int depth,
         std::size_t largest) {
  const Box box = tight_box(all + begin, all + end);
  if (end - begin <= largest || !must_split(box, end - begin, depth)) {
    pieces.push_back({begin, end, depth, {}});
    return;
  }
  const auto middle = static_cast<std::size_t>(split(box, all + begin, all + end) - all);
  cut(pieces, all, begin, middle, depth + 1, largest);
  cut(pieces, all, middle, end, depth + 1, largest);
}

// Appends the subtree that starts with `next` at this depth: depths, left to right, tell the shape of a binary tree.
void join(std::vector<TreeCell>& cells, std::vector<Piece>::const_iterator& next, int depth) {
  if (next->depth == depth) {
    cells.insert(cells.end(), next->cells.begin(), next->cells.end());
    ++next;
    return;
  }
  const std::size_t here = cells.size();
  const std::size_t begin = next->begin;
  cells.push_back(bare_cell({}, begin, 0));
  join(cells, next, depth + 1);
  join(cells, next, depth + 1);
  const TreeCell& a = cells[here + 1];
  const TreeCell& b = cells[here + 1 + a.span];
  cells[here] = bare_cell({a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)}, begin, a.count + b.count);
  close(cells, here);
}

} // namespace

void CellTree::build(std::vector<TreeParticle> particles) {
  particles_ = std::move(particles);
  cells_.clear();
  if (particles_.empty())
    return;
  // Any bound gives the same tree; this one gives threads enough pieces and each piece enough to do.
  const std::size_t largest = std::max<std::size_t>(512, particles_.size() / 64);
  std::vector<Piece> pieces;
  cut(pieces, particles_.data(), 0, particles_.size(), 0, largest);
  parallel_for(
      pieces.size(),
      [&](std::size_t k) { grow(pieces[k].cells, particles_.data(), pieces[k].begin, pieces[k].end, pieces[k].depth); },
      1);
  auto next = pieces.cbegin();
  join(cells_, next, 0);
}

} // namespace keeler
