#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace random_test {

using namespace keeler;

TEST_CASE("a stream depends on seed, purpose and id alone") {
  RandomStream a(7, RandomPurpose::size, 3), b(7, RandomPurpose::size, 3);
  for (int k = 0; k < 9; ++k)
    CHECK(a.uniform() == b.uniform());
  CHECK(RandomStream(7, RandomPurpose::size, 3).uniform() != RandomStream(8, RandomPurpose::size, 3).uniform());
  CHECK(RandomStream(7, RandomPurpose::size, 3).uniform() != RandomStream(7, RandomPurpose::size, 4).uniform());
  CHECK(RandomStream(7, RandomPurpose::size, 3).uniform() != RandomStream(7, RandomPurpose::position, 3).uniform());
}

TEST_CASE("uniform and normal have the moments of their distributions") {
  constexpr int count = 200000;
  double u1 = 0, u2 = 0, n1 = 0, n2 = 0, n4 = 0;
  RandomStream random(1, RandomPurpose::velocity, 0);
  for (int k = 0; k < count; ++k) {
    const double u = random.uniform(), n = random.normal();
    CHECK((u > 0.0 && u < 1.0));
    u1 += u, u2 += u * u, n1 += n, n2 += n * n, n4 += n * n * n * n;
  }
  // five standard errors of each mean
  CHECK(std::fabs(u1 / count - 0.5) < 5 * std::sqrt(1.0 / 12 / count));
  CHECK(std::fabs(u2 / count - 1.0 / 3) < 5 * std::sqrt(4.0 / 45 / count));
  CHECK(std::fabs(n1 / count) < 5 * std::sqrt(1.0 / count));
  CHECK(std::fabs(n2 / count - 1) < 5 * std::sqrt(2.0 / count));
  CHECK(std::fabs(n4 / count - 3) < 5 * std::sqrt(96.0 / count));
}

} // namespace random_test
