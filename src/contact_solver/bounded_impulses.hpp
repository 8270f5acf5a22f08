// Impulses that push and never pull: the least ones that keep joints of a network of bodies from closing. A convex
// quadratic problem with bounds,
//   find λ >= 0 with w = A λ − r >= 0 and λ · w = 0,   (A λ)_c = n_c · (Δv_high − Δv_low),   Δv of a body = Σ ± λ n /
//   m,
// solved by conjugate gradients on the joints that push, whose set is improved by gradient projections: MPRGP (Dostál &
// Schöberl 2005). Sums run in the order of the joints, so the bits depend on nothing else.
#pragma once

#include <keeler/core/vector.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// A joint between two of the bodies; `normal` points from `low` to `high`.
struct Joint {
  std::uint32_t low = 0, high = 0;
  Vec3 normal = Vec3::Zero();
};

class BoundedImpulses {
public:
  /// `inverse_masses` of the bodies, by number. Both must outlive this.
  BoundedImpulses(std::span<const Joint> joints, std::span<const double> inverse_masses);

  /// What impulses do to the velocities of the bodies.
  void push(std::span<const double> impulses, std::span<Vec3> changes) const;

  /// From a first guess in `impulses` to where each joint opens by `required` (m rad⁻¹), or more where it does not
  /// push, to within its tolerance. False when that takes more than 100,000 iterations, or no impulses do it.
  bool solve(std::span<const double> required, std::span<const double> tolerances, std::span<double> impulses);

  std::size_t iterations() const { return iterations_; }

private:
  /// A joint in units in which A has a unit diagonal: of impulses, 1 / √(1/m + 1/m'); of a body's velocity, 1 / √m.
  struct Row {
    std::uint32_t low = 0, high = 0;
    double at_low = 0.0, at_high = 0.0; // what a unit impulse does to each
    Vec3 normal = Vec3::Zero();
  };
  /// Of the gradient: what is left on joints that do not push, and on those that do; whether nothing more is to be
  /// done.
  struct Rest {
    double closing = 0.0, pushing = 0.0;
    bool settled = true;
  };
  /// Along the direction: its curvature, and the best length.
  struct Along {
    double curvature = 0.0, best = 0.0;
  };

  void push_along(const std::vector<double>& x);
  double opening(const Row& row) const;
  void start(std::span<const double> required, std::span<const double> tolerances, std::span<const double> impulses);
  void renew_gradient();
  Rest rest() const;
  Along look_along();
  bool keeps_pushing(double length) const;
  double feasible() const;
  void conjugate(const Along& along);
  void expand(double length);
  void proportion();

  std::span<const Joint> joints_;
  std::span<const double> inverse_masses_;
  std::vector<Row> rows_;
  std::vector<double> scales_; // units of the impulses
  double length_ = 0.0;        // of a projected step, below 2 over the largest eigenvalue
  std::size_t iterations_ = 0;

  // the problem at hand, in these units
  std::vector<double> x_, required_, tolerances_, gradient_, direction_, applied_; // applied: A times the direction
  std::vector<Vec3> changes_;
};

} // namespace keeler
