#include <keeler/diagnostics/autocorrelation.hpp>

#include "states.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace autocorrelation_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

constexpr int columns = 12, rows = 16;
const ShearingBox box{24.0, 40.0, 1.5, 0.0}; // cells of 2 × 2.5 m

using Mesh = std::vector<double>;

// Cloud-in-cell by definition: every image's overlap with every node.
Mesh cloud(const Patch& patch, std::size_t k) {
  const double dx = box.size_x / columns, dy = box.size_y / rows;
  Mesh mesh(columns * rows, 0.0);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j)
      for (int nx = -2; nx <= 2; ++nx)
        for (int ny = -3; ny <= 3; ++ny) {
          const Vec3 p = patch.positions[k] + box.displacement({nx, ny}, patch.offset);
          const double u = std::fabs(p.x() - (-12.0 + i * dx)) / dx, v = std::fabs(p.y() - (-20.0 + j * dy)) / dy;
          mesh[static_cast<std::size_t>(i * rows + j)] += std::max(0.0, 1.0 - u) * std::max(0.0, 1.0 - v);
        }
  return mesh;
}

// ⟨a(node) b(node + lag)⟩; the offset is `shift` whole cells.
double correlate(const Mesh& a, const Mesh& b, int lag_i, int lag_j, int shift) {
  double sum = 0.0;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      int to_i = i + lag_i, to_j = j + lag_j;
      for (; to_i >= columns; to_i -= columns)
        to_j += shift;
      for (; to_i < 0; to_i += columns)
        to_j -= shift;
      to_j = ((to_j % rows) + rows) % rows;
      sum += a[static_cast<std::size_t>(i * rows + j)] * b[static_cast<std::size_t>(to_i * rows + to_j)];
    }
  return sum / (columns * rows);
}

} // namespace

TEST_CASE("the transform equals the sum over all nodes, at real lags, without self-pairs") {
  for (const int shift : {0, 5, 13}) {
    Patch patch = test::uniform(box, shift * 2.5, 20, 1);
    double mass = 0.0;
    for (std::size_t k = 0; k < patch.size(); ++k)
      mass += patch.masses[k] = 1.0 + 0.1 * static_cast<double>(k);
    patch.positions[3].x() += 24.0; // outside the cell by its eccentricity
    patch.positions[3].y() -= patch.offset;

    std::vector<Mesh> clouds;
    Mesh all(columns * rows, 0.0);
    for (std::size_t k = 0; k < patch.size(); ++k) {
      clouds.push_back(cloud(patch, k));
      for (std::size_t n = 0; n < all.size(); ++n)
        all[n] += clouds[k][n] *= patch.masses[k] * columns * rows / mass;
    }
    Autocorrelation sum(box, columns, rows);
    sum.add(patch);
    const AutocorrelationMap map = sum.map();
    CHECK(map.reach == 9);
    double worst = 0.0;
    for (int i = -map.reach; i <= map.reach; ++i)
      for (int j = -rows / 2; j < rows / 2; ++j) {
        double expected = correlate(all, all, i, j, shift) - 1.0;
        for (std::size_t k = 0; k < patch.size(); ++k)
          if (std::abs(i) <= 1 && std::abs(j) <= 1) // at larger lags a cloud meets its own image, a true pair
            expected -= correlate(clouds[k], clouds[k], i, j, shift);
        worst = std::max(worst, std::fabs(map.value(i, j) - expected));
      }
    CHECK(worst < 1e-10); // values up to 10, transforms of 192 nodes
  }
}

TEST_CASE("a pair across the sheared edge is found at its real distance") {
  const double offset = 13.3; // not a whole number of cells
  Patch patch = test::uniform(box, offset, 2, 1);
  patch.positions[0] = Vec3(11.0, 3.0, 0.0);
  // The image of the second particle, 4 m outward and 2.5 m ahead of the first, is one box out.
  patch.positions[1] = patch.positions[0] + Vec3(4.0, 2.5, 0.0) + box.displacement({-1, 0}, offset);
  Autocorrelation sum(box, columns, rows);
  sum.add(patch);
  const AutocorrelationMap map = sum.map();
  int best_i = 0, best_j = 0;
  for (int i = 0; i <= columns / 2; ++i)
    for (int j = -rows / 2; j < rows / 2; ++j)
      if (map.value(i, j) > map.value(best_i, best_j)) {
        best_i = i;
        best_j = j;
      }
  CHECK(best_i == 2);
  CHECK(best_j == 1);
}

TEST_CASE("particles at random: nothing but the noise foretold, less when averaged") {
  const ShearingBox wide{240.0, 200.0, 1.5, 0.0};
  Autocorrelation sum(wide, 60, 50);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
    sum.add(test::uniform(wide, 37.0 * static_cast<double>(seed), 3000, seed));
  const AutocorrelationMap map = sum.map();
  CHECK(map.noise == doctest::Approx(std::sqrt(3000.0) / 3000.0 / 2.0).epsilon(1e-12));
  double squares = 0.0;
  for (const double value : map.values)
    squares += value * value;
  const double rms = std::sqrt(squares / static_cast<double>(map.values.size()));
  CHECK(rms < map.noise); // the clouds smooth by 4/9 at most
  CHECK(rms > 0.4 * map.noise);
}

TEST_CASE("the map interpolates between lags and is periodic along the orbit") {
  Autocorrelation sum(box, columns, rows);
  sum.add(test::uniform(box, 9.1, 50, 1));
  const AutocorrelationMap map = sum.map();
  CHECK(map.at(2.0, 5.0) == doctest::Approx(map.value(1, 2)).epsilon(1e-12));
  CHECK(map.at(-18.0, -20.0) == doctest::Approx(map.value(-9, -8)).epsilon(1e-12));
  CHECK(map.at(18.0, 0.0) == doctest::Approx(map.value(9, 0)).epsilon(1e-12));
  CHECK(map.at(3.0, 6.0) == doctest::Approx(map.at(3.0, 46.0)).epsilon(1e-12));
  CHECK(
      map.at(1.0, 18.75) ==
      doctest::Approx(0.25 * (map.value(0, 7) + map.value(1, 7) + map.value(0, -8) + map.value(1, -8))).epsilon(1e-12));
  CHECK(map.at(3.3, 6.1) == doctest::Approx(map.at(-3.3, -6.1)).epsilon(1e-9));
}

TEST_CASE("snapshots of different boxes are refused") {
  Autocorrelation sum(box, columns, rows);
  CHECK_THROWS_AS(sum.add(test::uniform({25.0, 40.0, 1.5, 0.0}, 0.0, 5, 1)), UsageError);
}

} // namespace autocorrelation_test
