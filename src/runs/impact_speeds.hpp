// How fast contacts were: counts and the energy lost in them by bins of normal speed, ten a decade from 1e-7 to 10 m/s,
// with a bin below and one above.
#pragma once

#include <keeler/core/field_table.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

class ImpactSpeeds {
public:
  ImpactSpeeds();

  /// Normal speed in m/s, energy in J.
  void add(double speed, double energy_lost);
  void clear();

  std::size_t bins() const { return counts_.size(); }
  double from(std::size_t bin) const; ///< m/s; 0 for the first
  double to(std::size_t bin) const;   ///< m/s; infinite for the last
  std::uint64_t count(std::size_t bin) const { return counts_[bin]; }
  double energy_lost(std::size_t bin) const { return energies_[bin]; }

  void list_fields(FieldTable& table);

private:
  std::vector<std::uint64_t> counts_;
  std::vector<double> energies_;
};

} // namespace keeler
