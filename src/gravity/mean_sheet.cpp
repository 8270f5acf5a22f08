#include <keeler/gravity/mean_sheet.hpp>

#include <keeler/core/units.hpp>
#include <keeler/gravity/images.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

// Logarithm and cosine by + − × / alone: those of libm may differ in the last bit from processor to processor.

// 2 artanh((m − 1)/(m + 1)) with m in [√½, √2]: the last term is below 3e-18.
double logarithm(double value) {
  int exponent = 0;
  double m = std::frexp(value, &exponent);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    --exponent;
  }
  const double t = (m - 1.0) / (m + 1.0);
  double series = 0.0;
  for (int k = 21; k >= 1; k -= 2)
    series = series * (t * t) + 1.0 / k;
  return 2.0 * t * series + exponent * 0.69314718055994531;
}

// For |angle| below ½: the first term left out is below 1e-18.
double cosine(double angle) {
  double series = 1.0;
  for (int k = 12; k >= 2; k -= 2)
    series = 1.0 - series * (angle * angle) / (k * (k - 1));
  return series;
}

// Zeros of T_n: cos((2 k + 1) π / 2 n), falling, by the recurrence in k.
std::vector<double> chebyshev_nodes(std::size_t n) {
  const double angle = 0.5 * pi / static_cast<double>(n);
  const double twice = 2.0 * cosine(2.0 * angle);
  std::vector<double> nodes(n);
  double last = cosine(angle), here = last;
  for (double& node : nodes) {
    node = here;
    here = twice * node - last;
    last = node;
  }
  return nodes;
}

// T_0 … T_(count − 1) at t.
void chebyshev(double t, std::size_t count, double* values) {
  values[0] = 1.0;
  values[1] = t;
  for (std::size_t k = 2; k < count; ++k)
    values[k] = 2.0 * t * values[k - 1] - values[k - 2];
}

// p + √(p² + q²), the exponential of asinh(p / q) times q, without cancellation.
double reach(double p, double q2) {
  const double root = std::sqrt(p * p + q2);
  return p >= 0.0 ? p + root : q2 / (root - p);
}

double square(double value) {
  return value * value;
}

} // namespace

MeanSheet::MeanSheet(const ShearingBox& box, double offset, int rings)
    : half_x_(0.5 * box.size_x), half_y_(0.5 * box.size_y), right_((rings + 0.5) * box.size_x),
      softening_(rings == 0 ? 0.05 * std::min(box.size_x, box.size_y) : 0.0) {
  const std::vector<Vec3> shifts = image_shifts(box, offset, rings);
  const auto side = static_cast<std::size_t>(2 * rings + 1);
  for (std::size_t k = 0; k < shifts.size(); k += side)
    columns_.push_back({shifts[k].x() - half_x_, shifts[k].y() - half_y_, shifts[k + side - 1].y() + half_y_});
  tabulate();
}

SheetField MeanSheet::closed_form(double x, double y) const {
  return {-covered_x(x, y), -covered_y(x, y), uncovered_stiffness(x, y)};
}

Vec3 MeanSheet::acceleration(const Vec3& place, double g_sigma) const {
  const SheetField field = tabulated(place.x(), place.y());
  const double slope = field.stiffness * place.z() / (2.0 * pi);
  return g_sigma * Vec3(field.x, field.y, -2.0 * pi * slope / std::sqrt(1.0 + slope * slope));
}

// With u, v the distances to an edge in x and y, a rectangle attracts by ∫ dv (1/√(u₁² + v²) − 1/√(u₂² + v²)), that is
// by F(u₁) − F(u₂), F = ln (v₂ + √(u² + v₂²)) (|v₁| + √(u² + v₁²)) − ln u². A particle may stand where two columns
// meet, at u = 0: their ln u² cancel and are left out here, except those of the outermost edges.
double MeanSheet::covered_x(double x, double y) const {
  const double h2 = square(softening_);
  double ratio = (square(right_ - x) + h2) / (square(columns_.front().left - x) + h2);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const double down = y - columns_[c].bottom, up = columns_[c].top - y;
    const double left2 = square(columns_[c].left - x) + h2, right2 = square(right_of(c) - x) + h2;
    ratio *= reach(up, left2) * reach(down, left2) / (reach(up, right2) * reach(down, right2));
  }
  return logarithm(ratio);
}

double MeanSheet::covered_y(double x, double y) const {
  const double h2 = square(softening_);
  double ratio = 1.0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const double left = columns_[c].left - x, right = right_of(c) - x;
    const double down2 = square(y - columns_[c].bottom) + h2, up2 = square(columns_[c].top - y) + h2;
    ratio *= reach(right, down2) * reach(left, up2) / (reach(left, down2) * reach(right, up2));
  }
  return logarithm(ratio);
}

// −√(u² + v²)/(u v) is a twofold integral of 1/d³: four of them for each column, √(1/u² + 1/v²) at the outermost edges.
// Where two columns meet the terms in 1/u cancel, and what is left is written so that u may be 0.
double MeanSheet::uncovered_stiffness(double x, double y) const {
  const auto corner = [this](double u, double v) {
    const double h2 = square(softening_);
    return std::sqrt(1.0 / (square(u) + h2) + 1.0 / (square(v) + h2));
  };
  const auto step = [](double u, double v_left, double v_right) {
    const double left = 1.0 / square(v_left), right = 1.0 / square(v_right);
    return u * (left - right) / (std::sqrt(1.0 + square(u) * left) + std::sqrt(1.0 + square(u) * right));
  };
  const Column &first = columns_.front(), &last = columns_.back();
  double sum = corner(first.left - x, first.bottom - y) + corner(first.left - x, first.top - y) +
               corner(right_ - x, last.bottom - y) + corner(right_ - x, last.top - y);
  for (std::size_t c = 1; c < columns_.size(); ++c) {
    const Column &a = columns_[c - 1], &b = columns_[c];
    sum += step(b.left - x, a.bottom - y, b.bottom - y) + step(b.left - x, a.top - y, b.top - y);
  }
  return sum;
}

// Columns meet with a step at x = ± L_x/2, L_y/2 or more beyond the cell: in a box that is long in x the field needs
// more polynomials there, about as the root of L_x/L_y.
void MeanSheet::tabulate() {
  const double wanted = 6.0 * std::sqrt(std::max(1.0, half_x_ / half_y_));
  const std::size_t x_terms = std::min(most_x_terms, 2 * static_cast<std::size_t>(std::ceil(wanted)));
  const std::vector<double> x_nodes = chebyshev_nodes(x_terms), y_nodes = chebyshev_nodes(y_terms);
  const double weight = 8.0 / static_cast<double>(x_terms * y_terms);
  rows_.assign(x_terms, {});
  for (std::size_t a = 0; a < x_terms / 2; ++a) { // nodes of negative x are images of these through the origin
    double tx[most_x_terms], ty[y_terms];
    Row along_y[2]; // for even and for odd i
    for (const double node : y_nodes) {
      const SheetField field = closed_form(half_x_ * x_nodes[a], half_y_ * node);
      chebyshev(node, y_terms, ty);
      ty[0] = 0.5; // its square's mean over the nodes is twice that of the others
      for (Eigen::Index odd = 0; odd < 2; ++odd)
        for (Eigen::Index k = 0; k < Half::RowsAtCompileTime; ++k) {
          along_y[odd].x[k] += field.x * ty[2 * k + 1 - odd];
          along_y[odd].y[k] += field.y * ty[2 * k + 1 - odd];
          along_y[odd].stiffness[k] += field.stiffness * ty[2 * k + odd];
        }
    }
    chebyshev(x_nodes[a], x_terms, tx);
    tx[0] = 0.5;
    for (std::size_t i = 0; i < x_terms; ++i) {
      rows_[i].x += weight * tx[i] * along_y[i % 2].x;
      rows_[i].y += weight * tx[i] * along_y[i % 2].y;
      rows_[i].stiffness += weight * tx[i] * along_y[i % 2].stiffness;
    }
  }
}

SheetField MeanSheet::tabulated(double x, double y) const {
  double tx[most_x_terms], ty[y_terms];
  chebyshev(x / half_x_, rows_.size(), tx);
  chebyshev(y / half_y_, y_terms, ty);
  const Eigen::Map<const Half, 0, Eigen::InnerStride<2>> even(ty), odd(ty + 1);
  SheetField field;
  for (const std::size_t first : {0, 1}) {
    Row sum;
    for (std::size_t i = first; i < rows_.size(); i += 2) {
      sum.x += tx[i] * rows_[i].x;
      sum.y += tx[i] * rows_[i].y;
      sum.stiffness += tx[i] * rows_[i].stiffness;
    }
    const Half plane = first == 0 ? odd : even, vertical = first == 0 ? even : odd;
    field.x += sum.x.dot(plane);
    field.y += sum.y.dot(plane);
    field.stiffness += sum.stiffness.dot(vertical);
  }
  return field;
}

} // namespace keeler
