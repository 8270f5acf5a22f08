#include <keeler/gravity/cell_tree.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

using namespace keeler;
using namespace keeler_test;

namespace {

std::vector<TreeParticle> particles_of(const ClumpedState& state) {
  std::vector<TreeParticle> particles;
  for (std::size_t k = 0; k < state.positions.size(); ++k) {
    const Vec3& p = state.positions[k];
    particles.push_back({p.x(), p.y(), p.z(), state.masses[k], state.ids[k], k});
  }
  return particles;
}

// Box and moments of a cell straight from their definitions.
void check_cell(const CellTree& tree, const TreeCell& cell) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  using Long33 = Eigen::Matrix<long double, 3, 3>;
  const TreeParticle* first = tree.particles().data() + cell.begin;
  Vec3 low(first->x, first->y, first->z), high = low;
  Long3 centre = Long3::Zero();
  long double mass = 0.0L;
  for (const TreeParticle* p = first; p != first + cell.count; ++p) {
    const Vec3 at(p->x, p->y, p->z);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    mass += p->mass;
    centre += static_cast<long double>(p->mass) * at.cast<long double>();
  }
  centre /= mass;
  Long33 quadrupole = Long33::Zero();
  for (const TreeParticle* p = first; p != first + cell.count; ++p) {
    const Long3 d = Vec3(p->x, p->y, p->z).cast<long double>() - centre;
    quadrupole += static_cast<long double>(p->mass) * (3.0L * d * d.transpose() - d.squaredNorm() * Long33::Identity());
  }
  const double extent = cell.size > 0.0 ? cell.size : 1.0;
  const double whole = static_cast<double>(mass);
  CHECK(cell.low == low);
  CHECK(cell.high == high);
  CHECK(cell.mass == doctest::Approx(whole).epsilon(1e-13));
  CHECK((cell.centre - centre.cast<double>()).norm() < 1e-13 * 100.0); // places up to 100 m, rounding 1e-16 of them
  const Long3 diagonal = quadrupole.diagonal(), mixed(quadrupole(0, 1), quadrupole(0, 2), quadrupole(1, 2));
  CHECK((cell.diagonal - diagonal.cast<double>()).norm() < 1e-11 * whole * extent * extent);
  CHECK((cell.mixed - mixed.cast<double>()).norm() < 1e-11 * whole * extent * extent);
}

} // namespace

TEST_CASE("cells partition the particles in preorder, with tight boxes and true moments") {
  CellTree tree;
  tree.build(particles_of(clumped_state(3000, 5, 10.0)));
  const std::vector<TreeCell>& cells = tree.cells();
  REQUIRE(!cells.empty());
  CHECK(cells[0].span == cells.size());
  CHECK(cells[0].count == 3000);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    check_cell(tree, cells[c]);
    if (cells[c].is_leaf()) {
      CHECK(cells[c].count <= CellTree::leaf_size);
      for (std::uint32_t k = 1; k < cells[c].count; ++k)
        CHECK(tree.particles()[cells[c].begin + k - 1].id < tree.particles()[cells[c].begin + k].id);
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

TEST_CASE("the tree ends where no split is possible") {
  CellTree tree;
  tree.build({});
  CHECK(tree.cells().empty());

  std::vector<TreeParticle> particles;
  for (std::size_t k = 0; k < 700; ++k)
    particles.push_back({1.0, 2.0, 3.0, 1.0, k, k});
  tree.build(particles);
  CHECK(tree.cells().size() == 1);

  for (std::size_t k = 0; k < 700; ++k) // neighbouring doubles: the middle of the box is one of its ends
    particles[k].x = k % 3 == 0 ? std::nextafter(1.0, 2.0) : 1.0;
  tree.build(particles);
  CHECK(tree.cells().size() == 3);

  for (std::size_t k = 0; k < 700; ++k) // each split takes off one particle
    particles[k].x = std::ldexp(1.0, -static_cast<int>(k));
  tree.build(particles);
  CHECK(tree.cells().size() == 2 * CellTree::deepest + 1);
}
