// Density and velocities of the particles of a patch, for warnings about a start.
#include "start_scale.hpp"

#include <keeler/core/exact_sum.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace keeler::initial_conditions {
namespace {

// Moments of t = (x − centre) / width of a stripe, and of the quantities q.
struct Moments {
  struct With {
    double sum = 0.0, squares = 0.0, products = 0.0; // Σ q, Σ q², Σ t q
  };
  double count = 0.0, sum = 0.0, squares = 0.0; // N, Σ t, Σ t²
  std::array<With, 4> of{};                     // v_x, v_y + S x, v_z, z

  void add(double t, const std::array<double, 4>& values) {
    count += 1.0;
    sum += t;
    squares += t * t;
    for (std::size_t k = 0; k < values.size(); ++k) {
      of[k].sum += values[k];
      of[k].squares += values[k] * values[k];
      of[k].products += t * values[k];
    }
  }

  void add(const Moments& more) {
    count += more.count;
    sum += more.sum;
    squares += more.squares;
    for (std::size_t k = 0; k < of.size(); ++k) {
      of[k].sum += more.of[k].sum;
      of[k].squares += more.of[k].squares;
      of[k].products += more.of[k].products;
    }
  }

  // Returns the moments in terms of t' = centre + width t.
  Moments rescaled(double centre, double width) const {
    Moments m = *this;
    m.sum = centre * count + width * sum;
    m.squares = centre * centre * count + 2.0 * centre * width * sum + width * width * squares;
    for (std::size_t k = 0; k < of.size(); ++k)
      m.of[k].products = centre * of[k].sum + width * of[k].products;
    return m;
  }

  double variance() const { return squares - sum * sum / count; }
  double slope(std::size_t k) const {
    return variance() > 0.0 ? (of[k].products - sum * of[k].sum / count) / variance() : 0.0;
  }
  /// Returns Σ (q − line of best fit)².
  double residual(std::size_t k) const {
    const double about_mean = of[k].squares - of[k].sum * of[k].sum / count;
    return std::max(0.0, about_mean - slope(k) * slope(k) * variance());
  }
};

enum Quantity : std::size_t { radial, azimuthal, vertical, height }; // three of the velocity, and z

// Stripes of equal width across the box. In each, the mean motion is linear in x, as on streamlines.
class Stripes {
public:
  Stripes(const Patch& patch, std::size_t count_of_all)
      : patch_(patch), moments_(std::clamp<std::size_t>(count_of_all / 50, 1, 32)) {}

  void add_particles() {
    for (std::size_t k = 0; k < patch_.size(); ++k) {
      const Vec3 c = diagnostics::peculiar_velocity(patch_, k);
      const double x = (patch_.positions[k].x() / patch_.box.size_x + 0.5) * number();
      const double stripe = std::clamp(std::floor(x), 0.0, number() - 1.0);
      moments_[static_cast<std::size_t>(stripe)].add(x - stripe - 0.5, {c.x(), c.y(), c.z(), patch_.positions[k].z()});
    }
  }

  /// Sums the moments of all ranks on the root.
  void gather(const Communicator& ranks) {
    if (!ranks.distributed())
      return;
    const std::vector<Moments> of_ranks = ranks.gather(moments_);
    const std::size_t stripes = moments_.size();
    for (std::size_t k = stripes; k < of_ranks.size(); ++k) // the root's come first
      moments_[k % stripes].add(of_ranks[k]);
  }

  /// Returns the standard deviation from the lines.
  double scatter(Quantity quantity) const {
    double squares = 0.0, freedom = 0.0;
    for (const Moments& m : moments_)
      if (m.count > 2.0) {
        squares += m.residual(quantity);
        freedom += m.count - 2.0;
      }
    return freedom > 0.0 ? std::sqrt(squares / freedom) : 0.0;
  }

  Moments whole() const {
    Moments sum;
    const double width = patch_.box.size_x / number();
    for (std::size_t k = 0; k < moments_.size(); ++k)
      sum.add(moments_[k].rescaled((static_cast<double>(k) + 0.5) * width - 0.5 * patch_.box.size_x, width));
    return sum;
  }

private:
  double number() const { return static_cast<double>(moments_.size()); }

  const Patch& patch_;
  std::vector<Moments> moments_;
};

// Returns −dv_y/dx / S if its error is small compared with S.
std::optional<double> shear_seen(const Moments& all, double shear) {
  constexpr double certain = 24.0; // S in standard errors
  const double freedom = all.count - 2.0;
  if (!(freedom > 0.0) || !(all.variance() > 0.0))
    return std::nullopt;
  const double error = std::sqrt(all.residual(azimuthal) / freedom / all.variance());
  const double rate = shear - all.slope(azimuthal);
  if (!(certain * error < std::max(shear, std::fabs(rate))))
    return std::nullopt;
  return rate / shear;
}

double largest_of(const std::vector<double>& values, const Communicator& ranks) {
  return ranks.max(values.empty() ? 0.0 : *std::max_element(values.begin(), values.end()));
}

double extent_of(const Patch& patch, int axis, const Communicator& ranks) {
  double farthest = 0.0;
  for (const Vec3& position : patch.positions)
    farthest = std::max(farthest, std::fabs(position[axis]));
  return 2.0 * ranks.max(farthest);
}

double over(double size, double extent) {
  return extent > 0.0 ? size / extent : std::numeric_limits<double>::infinity();
}

} // namespace

scene::StartScale start_scale_of(const Patch& patch, double mass, const Communicator& ranks) {
  assert(patch.velocities.size() == patch.size() && patch.box.area() > 0.0);
  scene::StartScale start;
  start.particle_count = ranks.sum(patch.size());
  auto radii = exact_total<ExactSum>(patch.size(), [&](ExactSum& sum, std::size_t k) { sum += patch.radii[k]; });
  auto squares = exact_total<ExactSum>(patch.size(),
                                       [&](ExactSum& sum, std::size_t k) { sum += patch.radii[k] * patch.radii[k]; });
  ranks.merge({&radii, &squares});
  const double largest_radius = largest_of(patch.radii, ranks), largest_mass = largest_of(patch.masses, ranks);
  const double extent_x = extent_of(patch, 0, ranks), extent_y = extent_of(patch, 1, ranks);
  Stripes stripes(patch, start.particle_count);
  stripes.add_particles();
  stripes.gather(ranks);
  if (!ranks.is_root() || start.particle_count == 0)
    return {};

  start.optical_depth = pi * squares.value() / patch.box.area();
  start.mean_radius = radii.value() / static_cast<double>(start.particle_count);
  start.usual_dispersion = scene::usual_dispersion(largest_radius, largest_mass, mass / patch.box.area(),
                                                   newton_g(patch.orbital_frequency), patch.frequencies.kappa);
  start.dispersion = std::max({stripes.scatter(radial), stripes.scatter(azimuthal), stripes.scatter(vertical)});
  start.height = stripes.scatter(height);
  start.spread_x = over(patch.box.size_x, extent_x);
  start.spread_y = over(patch.box.size_y, extent_y);
  start.orbital_frequency = patch.orbital_frequency;
  start.shear = patch.box.shear;
  const Moments all = stripes.whole();
  start.flat = 4.0 * all.residual(height) < all.variance();
  if (start.flat && start.spread_x < 2.0) // isolated aggregates may rotate differently
    start.shear_seen = shear_seen(all, start.shear);
  return start;
}

} // namespace keeler::initial_conditions
