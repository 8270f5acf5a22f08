// What rings of images lack of a periodic sheet, in the mean: the field of a uniform sheet of surface density Σ
// everywhere outside the boxes of the rings.
//
// In the plane an infinite uniform sheet pulls nowhere, so the field is minus that of the rectangles (columns of boxes)
// that the rings cover. Off the plane it is −G Σ z ∬ dA / d³ over the uncovered part, to first order in z. The field
// is smooth inside the cell, so each solve tabulates it once, by a product of Chebyshev polynomials in x and y.
#pragma once

#include <keeler/box/shearing_box.hpp>
#include <keeler/core/vector.hpp>

#include <vector>

namespace keeler {

/// The sheet's field at a place in the plane of the cell, per G Σ.
struct SheetField {
  double x = 0.0, y = 0.0; ///< acceleration / (G Σ)
  double stiffness = 0.0;  ///< −d a_z / dz / (G Σ), 1/m
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
  Vec3 acceleration(const Vec3& place, double g_sigma) const {
    const SheetField field = tabulated(place.x(), place.y());
    return g_sigma * Vec3(field.x, field.y, -field.stiffness * place.z());
  }

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

} // namespace keeler
