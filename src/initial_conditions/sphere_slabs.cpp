#include "sphere_slabs.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {

// Visits the ranks with slabs that intersect [low, high], each once.
template<class Visit> void SphereSlabs::visit_slabs(double low, double high, const Visit& visit) const {
  const auto slab = [&](double x) {
    return static_cast<std::int64_t>(std::floor((x + 0.5 * box_.size_x) / slab_width()));
  };
  const auto count = static_cast<std::int64_t>(ranks_.size());
  const std::int64_t first = slab(low), last = std::min(slab(high), first + count - 1);
  for (std::int64_t s = first; s <= last; ++s)
    visit(static_cast<std::size_t>((s % count + count) % count));
}

std::size_t SphereSlabs::owner(const Vec3& position) const {
  std::size_t owner = 0;
  visit_slabs(position.x(), position.x(), [&](std::size_t rank) { owner = rank; });
  return owner;
}

double SphereSlabs::distance_outside(const Vec3& position) const {
  const double middle = (static_cast<double>(ranks_.rank()) + 0.5) * slab_width() - 0.5 * box_.size_x;
  return std::max(0.0, std::fabs(std::remainder(position.x() - middle, box_.size_x)) - 0.5 * slab_width());
}

void SphereSlabs::add_copies(std::vector<Sphere>& spheres, double stretch) {
  assert(stretch >= 1.0);
  own_ = spheres.size();
  if (!ranks_.distributed())
    return;
  double largest = 0.0, outside = 0.0;
  for (const Sphere& sphere : spheres)
    if (!sphere.held) {
      largest = std::max(largest, sphere.radius);
      outside = std::max(outside, distance_outside(sphere.position));
    }
  largest = ranks_.max(largest);
  outside = ranks_.max(outside);
  sent_.assign(ranks_.size(), {});
  std::vector<std::vector<Sphere>> parcels(ranks_.size());
  for (std::size_t k = 0; k < own_; ++k) {
    const Sphere& sphere = spheres[k];
    const double reach = 1.001 * (stretch * (sphere.radius + largest) + outside), x = sphere.position.x();
    if (!sphere.held)
      visit_slabs(x - reach, x + reach, [&](std::size_t rank) {
        if (rank == ranks_.rank())
          return;
        sent_[rank].push_back(static_cast<std::uint32_t>(k));
        parcels[rank].push_back(sphere);
      });
  }
  for (const std::vector<Sphere>& copies : ranks_.exchange(parcels))
    spheres.insert(spheres.end(), copies.begin(), copies.end());
}

void SphereSlabs::update_copies(std::vector<Sphere>& spheres) const {
  if (!ranks_.distributed())
    return;
  assert(sent_.size() == ranks_.size() && own_ <= spheres.size());
  std::vector<std::vector<Vec3>> parcels(ranks_.size());
  for (std::size_t rank = 0; rank < parcels.size(); ++rank)
    for (const std::uint32_t k : sent_[rank])
      parcels[rank].push_back(spheres[k].position);
  auto copy = spheres.begin() + static_cast<std::ptrdiff_t>(own_);
  for (const std::vector<Vec3>& positions : ranks_.exchange(parcels))
    for (const Vec3& position : positions)
      (copy++)->position = position;
  assert(copy == spheres.end());
}

} // namespace keeler::initial_conditions
