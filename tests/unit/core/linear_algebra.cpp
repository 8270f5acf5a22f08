// Eigen's decompositions by what defines their results.
#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

namespace linear_algebra_test {

using namespace keeler;

namespace {

Eigen::MatrixXd normal_matrix(Eigen::Index rows, Eigen::Index columns, RandomStream& random) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped())
    entry = random.normal();
  return matrix;
}

} // namespace

TEST_CASE("what a least-squares solution leaves is perpendicular to the columns") {
  RandomStream random(1, RandomPurpose::position, 0);
  for (const Eigen::Index columns : {1, 3, 5}) {
    const Eigen::MatrixXd a = normal_matrix(7, columns, random), b = normal_matrix(7, 2, random);
    const LeastSquares fit = least_squares(a, b);
    CHECK(fit.rank == columns);
    CHECK((a.transpose() * (a * fit.solution - b)).cwiseAbs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("of all least-squares solutions the shortest is returned") {
  RandomStream random(2, RandomPurpose::position, 0);
  const Eigen::VectorXd once = normal_matrix(6, 1, random), b = normal_matrix(6, 1, random);
  Eigen::MatrixXd twice(6, 2); // only 2 x + y matters: the shortest has x = 2 y
  twice << 2.0 * once, once;
  const LeastSquares fit = least_squares(twice, b);
  CHECK(fit.rank == 1);
  const double of_one = once.dot(b) / once.squaredNorm();
  CHECK(fit.solution(0) == doctest::Approx(0.4 * of_one).epsilon(1e-13));
  CHECK(fit.solution(1) == doctest::Approx(0.2 * of_one).epsilon(1e-13));
}

TEST_CASE("the last eigenvector has the largest ratio of its two forms") {
  RandomStream random(3, RandomPurpose::position, 0);
  for (const Eigen::Index size : {1, 2, 4, 6}) {
    const Eigen::MatrixXd root = normal_matrix(size, size, random), other = normal_matrix(size, size, random);
    const Eigen::MatrixXd a = root + root.transpose();
    const Eigen::MatrixXd b = other * other.transpose() + Eigen::MatrixXd::Identity(size, size);
    const Eigen::VectorXd v = last_eigenvector(a, b);
    const double ratio = v.dot(a * v);
    CHECK(v.dot(b * v) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK((a * v - ratio * (b * v)).norm() < 1e-12 * a.norm());
    for (int k = 0; k < 200; ++k) {
      const Eigen::VectorXd any = normal_matrix(size, 1, random);
      CHECK(any.dot(a * any) / any.dot(b * any) <= ratio + 1e-12);
    }
  }
}

} // namespace linear_algebra_test
