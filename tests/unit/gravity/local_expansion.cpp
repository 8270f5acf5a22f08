#include "local_expansion.hpp"

#include "blocks.hpp"

#include <doctest/doctest.h>

#include <array>

namespace local_expansion_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

// Shrinks a block of targets about the origin.
SingleTargetBlock targets_within(double scale) {
  TargetBlock targets = random_targets();
  for (std::size_t k = 0; k < TargetBlock::capacity; ++k) {
    targets.x[k] *= scale;
    targets.y[k] *= scale;
    targets.z[k] *= scale;
  }
  return in_single(targets);
}

// Returns the relative rms error of the expansion against the cells.
double expansion_error(const std::vector<CellSource>& cells, double scale) {
  const AttractionKernels kernels = attraction_kernels(InstructionSet::portable);
  SingleTargetBlock exact = targets_within(scale), expanded = exact;
  kernels.cells(exact, 64, cells.data(), cells.size());
  LocalTerms terms{};
  kernels.far_cells(terms, far_cells(cells), cells.size());
  complete(terms);
  kernels.local(expanded, 64, terms);
  double error = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < 64; ++k) {
    error += std::pow(
        std::hypot(expanded.ax[k] - exact.ax[k], expanded.ay[k] - exact.ay[k], expanded.az[k] - exact.az[k]), 2);
    whole += std::pow(std::hypot(exact.ax[k], exact.ay[k], exact.az[k]), 2);
  }
  return std::sqrt(error / whole);
}

std::vector<CellSource> cells_all_around(double quadrupole) {
  std::vector<CellSource> cells = random_cells(40);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    CellSource& c = cells[k];
    const float x = c.x, y = c.y, z = c.z; // each third of them along another axis
    if (k % 3 == 1)
      c.x = z, c.y = x, c.z = y;
    else if (k % 3 == 2)
      c.x = y, c.y = z, c.z = -x;
    for (float* q : {&c.xx, &c.yy, &c.zz, &c.xy, &c.xz, &c.yz})
      *q *= static_cast<float>(quadrupole);
  }
  return cells;
}

} // namespace

TEST_CASE("a local expansion is exact to third order in the distance from its centre") {
  const std::vector<CellSource> cells = cells_all_around(0.0);
  const double wide = expansion_error(cells, 0.8), half = expansion_error(cells, 0.4);
  MESSAGE("rms error at 0.8 and 0.4 of 10: " << wide << " " << half);
  CHECK(wide < 4e-3);
  CHECK(half < wide / 12); // fourth order: 1/16
}

TEST_CASE("a local expansion holds the quadrupoles' field and its gradient") {
  std::vector<CellSource> cells = cells_all_around(1.0);
  for (CellSource& c : cells)
    c.mass = 0.0F;
  const double wide = expansion_error(cells, 0.4), half = expansion_error(cells, 0.2);
  MESSAGE("rms error at 0.4 and 0.2 of 10: " << wide << " " << half);
  CHECK(wide < 8e-2);
  CHECK(half < wide / 3.5); // second order: 1/4
}

TEST_CASE("a completed expansion has no traces, and completing it again changes nothing") {
  LocalTerms terms{};
  const std::vector<CellSource> cells = cells_all_around(1.0);
  attraction_kernels(InstructionSet::portable).far_cells(terms, far_cells(cells), cells.size());
  complete(terms);
  const float *t2 = terms.rank2, *t3 = terms.rank3, *t4 = terms.rank4;
  const auto none = [](float a, float b, float c) { // against their own size
    return std::fabs(a + b + c) <= 1e-6F * (std::fabs(a) + std::fabs(b) + std::fabs(c));
  };
  CHECK(none(t2[0], t2[3], t2[5]));
  for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 3, 5}, {1, 6, 8}, {2, 7, 9}})
    CHECK(none(t3[a], t3[b], t3[c]));
  for (const auto& [a, b, c] :
       std::vector<std::array<int, 3>>{{0, 3, 5}, {1, 6, 8}, {2, 7, 9}, {3, 10, 12}, {4, 11, 13}, {5, 12, 14}})
    CHECK(none(t4[a], t4[b], t4[c]));
}

} // namespace local_expansion_test
