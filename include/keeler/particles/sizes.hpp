// Size distributions of ring particles.
#pragma once

#include <keeler/core/key.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace keeler {

/// A distribution of radii (m).
struct SizeLaw {
  double smallest = 0.0, largest = 0.0;
  std::size_t listed = 0;                  ///< radii in a list or a table; 0 for a continuous law
  std::function<double(int k)> mean_power; ///< ⟨r^k⟩
  /// The k-th radius, at the quantile u in (0, 1).
  std::function<double(double u, std::size_t k)> radius;
  /// Density of its material, kg/m³; empty where sizes say nothing about it.
  std::function<double(double u, std::size_t k)> density{};
  double mean_density = 0.0; ///< by volume, where they do
};

SizeLaw equal_sizes(double radius);

/// n(r) dr ∝ r^−q between two radii, min < max.
SizeLaw power_sizes(double exponent, double min, double max);

/// The radii of a list in turn: k stands for the (k mod length)-th one.
SizeLaw listed_sizes(std::vector<double> radii);

/// A table of radii, each with the number of particles that have it, above 0, in proportion: of as many particles as
/// the table has in all, and of nearly as many, each row has its number. At least one row.
SizeLaw tabulated_sizes(NumberRows table);

/// A table of radii, each with a number as above and with the density (kg/m³) of its particles.
SizeLaw populations(const NumberRows& table);

/// The sizes of particles 0 … count−1: the quantiles of the law at jittered even spacing, in a shuffled order, so that
/// even a small sample has the law's moments. Each particle's is found by itself, whatever the others'. Same seed, same
/// sizes.
class DrawnSizes {
public:
  DrawnSizes(const SizeLaw& law, std::size_t count, std::uint64_t seed) : law_(law), count_(count), seed_(seed) {}

  double radius(std::size_t particle) const; ///< m; of one below count
  bool has_densities() const { return static_cast<bool>(law_.density); }
  double density(std::size_t particle) const; ///< kg/m³; only where the law has densities

private:
  double value(const std::function<double(double u, std::size_t k)>& quantile, std::size_t particle) const;

  SizeLaw law_;
  std::size_t count_;
  std::uint64_t seed_;
};

/// The radii of all of them, m.
std::vector<double> draw_radii(const SizeLaw& law, std::size_t count, std::uint64_t seed);

/// A law that a scene can choose: its name, its keys, and how it is made from their values. `make` throws UsageError
/// when the values do not fit together.
struct SizeEntry {
  const char* name;
  std::vector<Key> keys;
  SizeLaw (*make)(const Parameters& parameters);
};

/// All laws. A new one is one more entry here.
const std::vector<SizeEntry>& size_laws();

} // namespace keeler
