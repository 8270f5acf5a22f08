#include "size_classes.hpp"

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::diagnostics {
namespace {

struct ClassSums {
  std::size_t count = 0;
  double mass = 0.0, heights = 0.0;
  Vec3 squares = Vec3::Zero();

  ClassSums& operator+=(const ClassSums& more) {
    count += more.count;
    mass += more.mass;
    heights += more.heights;
    squares += more.squares;
    return *this;
  }
};

SizeClass size_class(const Patch& patch, double smallest, double largest, bool last, const Vec3& mean) {
  const ClassSums sums = ordered_total<ClassSums>(patch.size(), [&](ClassSums& total, std::size_t k) {
    const double r = patch.radii[k], m = patch.masses[k], z = patch.positions[k].z();
    if (r < smallest || (last ? r > largest : r >= largest))
      return;
    const Vec3 v = peculiar_velocity(patch, k) - mean;
    ++total.count;
    total.mass += m;
    total.heights += m * z * z;
    total.squares += m * v.cwiseProduct(v);
  });
  SizeClass result;
  result.smallest = smallest;
  result.largest = largest;
  result.count = sums.count;
  result.mass_fraction = sums.mass / total_mass(patch);
  if (sums.count > 0) {
    result.dispersion = (sums.squares / sums.mass).cwiseSqrt();
    result.scale_height = std::sqrt(sums.heights / sums.mass);
  }
  return result;
}

} // namespace

std::vector<SizeClass> size_classes(const Patch& patch, int classes) {
  assert(classes > 0);
  if (patch.radii.empty())
    return {};
  const double smallest = *std::min_element(patch.radii.begin(), patch.radii.end());
  const double largest = *std::max_element(patch.radii.begin(), patch.radii.end());
  if (smallest == largest)
    return {};
  const Vec3 mean = mean_velocity(patch);
  const double step = std::log(largest / smallest) / classes;
  std::vector<SizeClass> result;
  for (int c = 0; c < classes; ++c) { // neighbours have bit-identical limits
    const auto limit = [&](int edge) {
      return edge == 0 ? smallest : edge == classes ? largest : smallest * std::exp(step * edge);
    };
    result.push_back(size_class(patch, limit(c), limit(c + 1), c + 1 == classes, mean));
  }
  return result;
}

} // namespace keeler::diagnostics
