#include "cell_tree.hpp"

#include "clumped_state.hpp"

#include <doctest/doctest.h>

namespace cell_tree_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

struct Input {
  std::vector<PointSource> particles;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint64_t> ids;

  void add(const Vec3& p, double mass, std::uint64_t id) {
    indices.push_back(static_cast<std::uint32_t>(indices.size()));
    particles.push_back({p.x(), p.y(), p.z(), mass});
    ids.push_back(id);
  }

  CellTree tree() const {
    CellTree tree;
    tree.build(particles, indices, ids);
    return tree;
  }
};

Input input_of(const ClumpedState& state) {
  Input input;
  for (std::size_t k = 0; k < state.positions.size(); ++k)
    input.add(state.positions[k], state.masses[k], state.ids[k]);
  return input;
}

// Checks box and moments of a cell against their definitions.
void check_cell(const CellTree& tree, std::size_t index) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  using Long33 = Eigen::Matrix<long double, 3, 3>;
  const TreeCell& cell = tree.cells()[index];
  const CellBox& box = tree.boxes()[index];
  const CellMoments& moments = tree.moments()[index];
  const PointSource* first = tree.particles().data() + cell.begin;
  Eigen::Vector3f low(static_cast<float>(first->x), static_cast<float>(first->y), static_cast<float>(first->z));
  Eigen::Vector3f high = low;
  Long3 centre = Long3::Zero();
  long double mass = 0.0L;
  for (const PointSource* p = first; p != first + cell.count; ++p) {
    const Vec3 at(p->x, p->y, p->z);
    low = low.cwiseMin(at.cast<float>());
    high = high.cwiseMax(at.cast<float>());
    mass += p->mass;
    centre += static_cast<long double>(p->mass) * at.cast<long double>();
  }
  centre /= mass;
  Long33 quadrupole = Long33::Zero();
  float reach = 0.0F;
  for (const PointSource* p = first; p != first + cell.count; ++p) {
    const Long3 d = Vec3(p->x, p->y, p->z).cast<long double>() - centre;
    quadrupole += static_cast<long double>(p->mass) * (3.0L * d * d.transpose() - d.squaredNorm() * Long33::Identity());
    reach = std::max(reach, static_cast<float>(d.norm()));
  }
  quadrupole /= tree.mass_unit();
  mass /= tree.mass_unit();
  CHECK(Eigen::Vector3f(box.low) == low);
  CHECK(Eigen::Vector3f(box.high) == high);
  CHECK(cell.size == (high - low).maxCoeff());
  CHECK(cell.reach > reach - 1e-4F); // rounding of positions up to 100 m
  CHECK(cell.reach < 1.8F * cell.size + 1e-4F);
  const double extent = std::max(1e-3, static_cast<double>(cell.size)), whole = static_cast<double>(mass);
  CHECK(moments.mass == doctest::Approx(whole).epsilon(1e-7));
  const Vec3 found(double(cell.x) + moments.x_low, double(cell.y) + moments.y_low, double(cell.z) + moments.z_low);
  CHECK((found - centre.cast<double>()).norm() < 1e-12 * 100.0); // two floats hold 2^-46 of it
  const Eigen::Vector3d diagonal(moments.xx, moments.yy, moments.zz), mixed(moments.xy, moments.xz, moments.yz);
  const Long3 true_diagonal = quadrupole.diagonal(), true_mixed(quadrupole(0, 1), quadrupole(0, 2), quadrupole(1, 2));
  CHECK((diagonal - true_diagonal.cast<double>()).norm() < 3e-7 * whole * extent * extent);
  CHECK((mixed - true_mixed.cast<double>()).norm() < 3e-7 * whole * extent * extent);
}

} // namespace

TEST_CASE("cells partition the particles in preorder, with tight boxes and true moments") {
  const Input input = input_of(clumped_state(3000, 5, 10.0));
  const CellTree tree = input.tree();
  const std::vector<TreeCell>& cells = tree.cells();
  REQUIRE(!cells.empty());
  CHECK(cells[0].span == cells.size());
  CHECK(cells[0].count == 3000);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    check_cell(tree, c);
    if (cells[c].is_leaf()) {
      CHECK(cells[c].count <= CellTree::leaf_size);
    } else {
      const TreeCell& a = cells[c + 1];
      const TreeCell& b = cells[c + 1 + a.span];
      CHECK(cells[c].count > CellTree::leaf_size);
      CHECK(a.span + b.span + 1 == cells[c].span);
      CHECK(a.begin == cells[c].begin);
      CHECK(b.begin == a.begin + a.count);
      CHECK(a.count + b.count == cells[c].count);
    }
  }
}

TEST_CASE("the tree has the given particles, in an order that does not depend on that of the input") {
  Input input = input_of(clumped_state(2000, 6));
  for (std::size_t k = 0; k < 40; ++k) // ties, decided by the ids
    input.particles[k].x = input.particles[0].x;
  const CellTree tree = input.tree();
  Input other;
  for (std::size_t k = 0; k < 2000; ++k) { // 1999 is prime
    const std::size_t from = (k * 1999 + 7) % 2000;
    other.particles.push_back(input.particles[from]);
    other.indices.push_back(input.indices[from]);
  }
  other.ids = input.ids;
  const CellTree reordered = other.tree();
  CHECK(reordered.order() == tree.order());
  for (std::size_t k = 0; k < 2000; ++k) {
    const PointSource &p = tree.particles()[k], &q = input.particles[tree.order()[k]];
    CHECK((p.x == q.x && p.y == q.y && p.z == q.z && p.mass == q.mass));
    const SinglePoint& single = tree.points()[k];
    CHECK(std::fabs(double(single.x) + single.x_low - p.x) < 1e-12);
    CHECK(single.mass == static_cast<float>(p.mass / tree.mass_unit()));
  }
}

TEST_CASE("the tree ends where no split is possible") {
  CHECK(Input{}.tree().cells().empty());

  Input input;
  for (std::size_t k = 0; k < 700; ++k)
    input.add({1.0, 2.0, 3.0}, 1.0, k);
  CHECK(input.tree().cells().size() == 1);

  for (std::size_t k = 0; k < 700; ++k) // neighbouring floats: the middle of the box is one of its ends
    input.particles[k].x = k % 3 == 0 ? std::nextafter(1.0F, 2.0F) : 1.0F;
  CHECK(input.tree().cells().size() == 3);

  for (std::size_t k = 0; k < 700; ++k) // each split separates one particle, down to the smallest floats
    input.particles[k].x = std::ldexp(1.0, -static_cast<int>(k % 140));
  const CellTree deep = input.tree();
  CHECK(deep.cells().size() == 2 * CellTree::max_depth + 1);
}

} // namespace cell_tree_test
