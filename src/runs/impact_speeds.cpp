#include "impact_speeds.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::runs {
namespace {

constexpr int lowest_decade = -7, highest_decade = 1, bins_per_decade = 10;
constexpr std::size_t edge_count = (highest_decade - lowest_decade) * bins_per_decade + 1;

const std::array<double, edge_count>& edges() {
  static const auto all = [] {
    std::array<double, edge_count> made{};
    for (std::size_t k = 0; k < edge_count; ++k)
      made[k] = std::pow(10.0, lowest_decade + static_cast<double>(k) / bins_per_decade);
    return made;
  }();
  return all;
}

} // namespace

ImpactSpeeds::ImpactSpeeds() : counts_(edge_count + 1), energies_(edge_count + 1) {}

void ImpactSpeeds::add(double speed, double energy_lost) {
  assert(!std::isnan(speed));
  const auto bin = static_cast<std::size_t>(std::upper_bound(edges().begin(), edges().end(), speed) - edges().begin());
  ++counts_[bin];
  energies_[bin] += energy_lost;
}

void ImpactSpeeds::clear() {
  std::fill(counts_.begin(), counts_.end(), 0);
  std::fill(energies_.begin(), energies_.end(), 0.0);
}

double ImpactSpeeds::lower_edge(std::size_t bin) const {
  assert(bin < bins());
  return bin == 0 ? 0.0 : edges()[bin - 1];
}

double ImpactSpeeds::upper_edge(std::size_t bin) const {
  assert(bin < bins());
  return bin == edge_count ? std::numeric_limits<double>::infinity() : edges()[bin];
}

void ImpactSpeeds::list_fields(FieldTable& table) {
  table.rows<std::uint64_t>("impact_counts", counts_, "1", "contacts by bins of normal speed since the last snapshot");
  table.rows<double>("impact_energies", energies_, "J", "energy lost in them");
}

} // namespace keeler::runs
