// Eigen's decompositions, compiled in one object for all folders: a source that sees one takes 10 to 30 s longer under
// a sanitizer.
#pragma once

#include <Eigen/Core>

namespace keeler {

struct LeastSquares {
  Eigen::MatrixXd solution; // one column for each of b
  Eigen::Index rank;        // of a
};

// Returns the x that make |a x − b| smallest, for each column of b, and of these the shortest: by a complete orthogonal
// decomposition of a. Needs as many rows in b as in a.
LeastSquares least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

// Returns the v of a v = λ b v with the largest λ, with vᵀ b v = 1. Needs a symmetric, and b symmetric and positive
// definite.
Eigen::VectorXd last_eigenvector(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

} // namespace keeler
