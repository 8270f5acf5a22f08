// Size distributions of ring particles.
#pragma once

#include <keeler/core/key.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace keeler::particles {

/// A size distribution, radii in m. Its functions are called from several threads at once.
struct SizeLaw {
  double smallest = 0.0;                   ///< smallest radius, m
  double largest = 0.0;                    ///< largest radius, m
  std::size_t listed = 0;                  ///< number of radii in a list or a table; 0 for a continuous law
  std::function<double(int k)> mean_power; ///< ⟨r^k⟩, k from 0 to 6
  /// Returns the k-th radius, at the quantile u in (0, 1). It must depend on u and k only.
  std::function<double(double u, std::size_t k)> radius;
  /// Returns its density, kg/m³; empty if the law does not define densities.
  std::function<double(double u, std::size_t k)> density{};
  double mean_density = 0.0; ///< volume-weighted, kg/m³, if it does
};

/// All particles have one radius. Precondition: radius > 0.
SizeLaw equal_sizes(double radius);

/// Power law n(r) dr ∝ r^−q. Precondition: 0 < min < max.
SizeLaw power_sizes(double exponent, double min, double max);

/// Uses the radii of a list in turn: particle k has the (k mod length)-th one. Precondition: the list is not empty.
SizeLaw listed_sizes(std::vector<double> radii);

/// Uses a table of rows (radius, number > 0), in proportion to the numbers. For as many particles as their sum, or
/// nearly as many, the counts are exact. Precondition: at least one row.
SizeLaw tabulated_sizes(NumberRows table);

/// Uses a table of rows (radius, number, density in kg/m³), with numbers as in tabulated_sizes().
SizeLaw populations(const NumberRows& table);

/// The sizes of particles 0 … count−1: stratified quantiles of the law in shuffled order, so that even a small sample
/// has the moments of the law. Each size is computed independently of the others, and depends only on law, count and
/// seed.
class DrawnSizes {
public:
  /// Sizes for this many particles.
  DrawnSizes(const SizeLaw& law, std::size_t count, std::uint64_t seed) : law_(law), count_(count), seed_(seed) {}

  double radius(std::size_t particle) const;                             ///< m. Precondition: particle < count
  bool has_densities() const { return static_cast<bool>(law_.density); } ///< true if the law has them
  double density(std::size_t particle) const;                            ///< kg/m³. Precondition: has_densities()

private:
  double value(const std::function<double(double u, std::size_t k)>& quantile, std::size_t particle) const;

  SizeLaw law_;
  std::size_t count_;
  std::uint64_t seed_;
};

/// Returns the radii of all particles, m.
std::vector<double> draw_radii(const SizeLaw& law, std::size_t count, std::uint64_t seed);

/// Throws UsageError unless the radii lie between `smallest` and `largest`, which are positive, and the mean powers fit
/// these limits.
void require_consistent(const SizeLaw& law);

/// A size law that a scene can choose: particles.sizes = { law = NAME, … }.
struct SizeEntry {
  const char* name;      ///< a literal
  std::vector<Key> keys; ///< by their names in the table, which all laws share; they only affect the start
  /// Makes the law from the checked values; throws UsageError if they do not fit together.
  std::function<SizeLaw(const Parameters& parameters)> make;
};

/// Adds a law of the calling program, in any thread, which scenes can choose from then on. Throws UsageError for an
/// invalid entry, a name or a key that is taken.
void add_size_law(SizeEntry entry, IfTaken if_taken = IfTaken::refuse);

/// Returns all size laws. The list never changes: what is added later is in another one.
const std::vector<SizeEntry>& size_laws();

} // namespace keeler::particles
