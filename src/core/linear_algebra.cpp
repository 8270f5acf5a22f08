#include "linear_algebra.hpp"

#include <Eigen/Dense>

#include <cassert>

namespace keeler {

LeastSquares least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  assert(a.rows() == b.rows());
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed(a);
  return {decomposed.solve(b), decomposed.rank()};
}

Eigen::VectorXd last_eigenvector(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  assert(a.rows() == a.cols() && b.rows() == a.rows() && b.cols() == a.rows());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(a, b);
  return solved.eigenvectors().rightCols<1>();
}

} // namespace keeler
