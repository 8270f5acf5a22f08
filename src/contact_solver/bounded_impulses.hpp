// Impulses that push and never pull: the smallest ones that keep the joints of a network of bodies from closing. The
// convex quadratic problem with bounds
//   find λ >= 0 with w = A λ − r >= 0 and λ · w = 0,   (A λ)_c = n_c · (Δv_high − Δv_low),   Δv of a body = Σ ± λ n / m
// is solved by MPRGP (Dostál & Schöberl 2005): conjugate gradients on the free set (joints that push), which gradient
// projections enlarge or reduce. Sums run in the order of the joints, so the bits depend on nothing else.
#pragma once

#include <keeler/core/vector.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler::contact_solver {

/// A joint between two of the bodies; `normal` points from `low` to `high`.
struct Joint {
  std::uint32_t low = 0, high = 0;
  Vec3 normal = Vec3::Zero();
};

class BoundedImpulses {
public:
  /// Precondition: bodies of joints are indices into `inverse_masses`, and each joint has one that can move. Both
  /// arrays must outlive this object.
  BoundedImpulses(std::span<const Joint> joints, std::span<const double> inverse_masses);

  /// Writes the velocity change of each body by these impulses.
  void apply(std::span<const double> impulses, std::span<Vec3> changes) const;

  /// Improves `impulses` from a first guess until each joint opens by `required` (m rad⁻¹), or by more where its
  /// impulse is zero, to within its tolerance. Returns false after 100,000 iterations or if no impulses exist.
  bool solve(std::span<const double> required, std::span<const double> tolerances, std::span<double> impulses);

private:
  /// A joint in units in which A has a unit diagonal: of impulses, 1 / √(1/m + 1/m'); of a body's velocity, 1 / √m.
  struct Row {
    std::uint32_t low = 0, high = 0;
    double at_low = 0.0, at_high = 0.0; // velocity changes by a unit impulse
    Vec3 normal = Vec3::Zero();
  };
  /// Squared norms of the projected gradient on the bound set (joints without an impulse) and on the free set.
  struct Residual {
    double bound = 0.0, free = 0.0;
    bool converged = true;
  };
  /// The quadratic form along the search direction: its curvature, and the length to its minimum.
  struct LineSearch {
    double curvature = 0.0, best = 0.0;
  };

  void apply_scaled(const std::vector<double>& x);
  double opening(const Row& row) const;
  void start(std::span<const double> required, std::span<const double> tolerances, std::span<const double> impulses);
  void recompute_gradient();
  Residual residual() const;
  LineSearch line_search();
  bool stays_feasible(double length) const;
  double max_feasible_length() const;
  void conjugate_step(const LineSearch& line);
  void expansion_step(double length);
  void proportioning_step();

  std::span<const Joint> joints_;
  std::span<const double> inverse_masses_;
  std::vector<Row> rows_;
  std::vector<double> scales_; // units of the impulses
  double step_length_ = 0.0;   // of a projected gradient step, below 2 / (largest eigenvalue of A)

  // the current problem, in these units
  std::vector<double> x_, required_, tolerances_, gradient_, direction_, applied_; // applied_ = A direction_
  std::vector<Vec3> changes_;
};

} // namespace keeler::contact_solver
