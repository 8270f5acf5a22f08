// A histogram of impact speeds: number of contacts and energy lost per bin of normal speed, ten bins per decade from
// 1e-7 to 10 m/s, with one bin below and one above.
#pragma once

#include <keeler/core/field_table.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler::runs {

class ImpactSpeeds {
public:
  ImpactSpeeds();

  /// Adds a contact; normal speed in m/s, energy in J. Precondition: the speed is not NaN.
  void add(double speed, double energy_lost);
  void clear();

  std::size_t bins() const { return counts_.size(); }
  double lower_edge(std::size_t bin) const; ///< m/s; 0 for the first bin
  double upper_edge(std::size_t bin) const; ///< m/s; infinite for the last bin
  std::uint64_t count(std::size_t bin) const { return counts_[bin]; }
  double energy_lost(std::size_t bin) const { return energies_[bin]; }

  void list_fields(FieldTable& table);

private:
  std::vector<std::uint64_t> counts_;
  std::vector<double> energies_;
};

} // namespace keeler::runs
