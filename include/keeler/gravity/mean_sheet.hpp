// What rings of images lack of a periodic sheet, in the mean: the field of a uniform sheet of surface density Σ
// everywhere outside the boxes of the rings.
//
// In the plane an infinite uniform sheet pulls nowhere, so the field is minus that of the rectangles (columns of boxes)
// that the rings cover. Off the plane it is −G Σ z K, K = ∬ dA / d³ over the uncovered part, to first order in z; as
// around a disk of radius 2π/K it goes over to −2π G Σ high above. Errors are of the order (z/L)² of the field. It is
// smooth inside the cell, so each solve tabulates it once, by products of Chebyshev polynomials in x and y.
#pragma once

#include <keeler/box/shearing_box.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/vector.hpp>
#include <keeler/gravity/solver.hpp>

#include <vector>

namespace keeler {

/// The sheet's field at a place in the plane of the cell, per G Σ.
struct SheetField {
  double x = 0.0, y = 0.0; ///< acceleration / (G Σ)
  double stiffness = 0.0;  ///< K = −d a_z / dz / (G Σ), 1/m
};

class MeanSheet {
public:
  /// The sheet around the boxes of image_shifts(box, offset, rings). The offset must be folded (images.hpp).
  MeanSheet(const ShearingBox& box, double offset, int rings);

  /// The closed form. The place must lie in the cell. Without rings the sheet begins at the cell's own edges, where its
  /// field would be infinite: it is then seen from the height softening().
  SheetField closed_form(double x, double y) const;

  /// The same from the table.
  SheetField tabulated(double x, double y) const;

  /// Acceleration at a place in the cell due to a sheet with that G Σ.
  Vec3 acceleration(const Vec3& place, double g_sigma) const;

  /// 0 with rings; 1/20 of the cell's shorter side without, m.
  double softening() const { return softening_; }

private:
  static constexpr std::size_t y_terms = 12;
  static constexpr std::size_t most_x_terms = 48;

  using Half = Eigen::Matrix<double, y_terms / 2, 1>;

  /// Coefficients of T_i(2x/L_x) T_j(2y/L_y) for one i. The covered boxes are symmetric about the origin, so x and y
  /// hold terms of odd i + j only and the stiffness even ones: entry k belongs to j = 2 k or 2 k + 1.
  struct Row {
    Half x = Half::Zero(), y = Half::Zero(), stiffness = Half::Zero();
  };

  /// A column of boxes from x = left to the next column, or to right_ for the last.
  struct Column {
    double left, bottom, top;
  };

  double right_of(std::size_t column) const {
    return column + 1 < columns_.size() ? columns_[column + 1].left : right_;
  }
  double covered_x(double x, double y) const;
  double covered_y(double x, double y) const;
  double uncovered_stiffness(double x, double y) const;
  void tabulate();

  double half_x_, half_y_, right_, softening_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

/// What the sheet adds to the acceleration of each body, m rad^-2; Σ is the mean surface density of the bodies. Bodies
/// have x, y, z inside the cell and a mass, and stand in an order that depends on the problem alone.
///
/// The mass-weighted mean is taken out, so that the sheet exerts no net force. The field grows about linearly across
/// the cell, and what the far images really do depends on the distances between bodies: it is linear in the distance
/// from their centre of mass, not from the middle of the cell.
template<class Body>
std::vector<Vec3> sheet_accelerations(const GravityProblem& problem, double offset, int rings,
                                      const std::vector<Body>& bodies) {
  const MeanSheet sheet(problem.box, offset, rings);
  const std::size_t count = bodies.size();
  const double mass = ordered_sum(count, [&](std::size_t k) { return bodies[k].mass; });
  const double g_sigma = problem.newton_g * mass / problem.box.area();
  std::vector<Vec3> result(count);
  parallel_for(count, [&](std::size_t k) {
    result[k] = sheet.acceleration({bodies[k].x, bodies[k].y, bodies[k].z}, g_sigma);
  });
  if (mass > 0.0) {
    Vec3 mean;
    for (int axis = 0; axis < 3; ++axis)
      mean[axis] = ordered_sum(count, [&](std::size_t k) { return bodies[k].mass * result[k][axis]; }) / mass;
    parallel_for(count, [&](std::size_t k) { result[k] -= mean; });
  }
  return result;
}

} // namespace keeler
