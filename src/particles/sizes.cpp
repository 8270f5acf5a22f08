#include <keeler/particles/sizes.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/registry.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace keeler::particles {
namespace {

// Returns ∫ r^p dr from a to b.
double power_integral(double p, double a, double b) {
  return std::fabs(p + 1.0) < 1e-12 ? std::log(b / a) : (std::pow(b, p + 1.0) - std::pow(a, p + 1.0)) / (p + 1.0);
}

// Returns the quantile u of a power law.
double power_quantile(double exponent, double min, double max, double u) {
  const double p = 1.0 - exponent;
  if (std::fabs(p) < 1e-12)
    return min * std::pow(max / min, u);
  const double low = std::pow(min, p), high = std::pow(max, p);
  return std::clamp(std::pow(low + u * (high - low), 1.0 / p), min, max);
}

SizeLaw make_power(const Parameters& p) {
  const double min = p.number("min"), max = p.number("max");
  if (min >= max)
    throw UsageError(fmt::format("min = {} is not below max = {} (a power law needs a range); lower min, or write "
                                 "law = \"equal\"",
                                 min, max));
  return power_sizes(p.number("exponent"), min, max);
}

SizeLaw make_listed(const Parameters& p) {
  std::vector<double> radii;
  for (const std::vector<double>& row : p.rows("path"))
    radii.push_back(row[0]);
  return listed_sizes(std::move(radii));
}

constexpr KeyRange radius_range = {.low = 1e-6, .high = 1e6}; // wide: only mistakes of units are outside

constexpr KeyRange density_range = {.low = 1e-2, .high = 3e4}; // up to the densest metals

const NumberRows& checked_rows(const NumberRows& table) {
  if (table.empty())
    throw UsageError("it has no rows; give at least one radius and its number");
  for (const std::vector<double>& row : table)
    if (!radius_range.contains(row[0]))
      throw UsageError(fmt::format("the radius {} is {} m (it must be {}); correct it", &row - table.data() + 1, row[0],
                                   radius_range.words()));
  return table;
}

SizeLaw make_table(const Parameters& p) {
  return tabulated_sizes(checked_rows(p.rows("table")));
}

SizeLaw make_populations(const Parameters& p) {
  if (!p.has("populations"))
    throw UsageError("populations are missing (particles.density is for laws without them); give populations = "
                     "[[30.0, 1, 450.0], [1.0, 19999, 900.0]] in its place");
  const NumberRows& table = checked_rows(p.rows("populations"));
  for (const std::vector<double>& row : table)
    if (!density_range.contains(row[2]))
      throw UsageError(fmt::format("the density {} is {} kg/m^3 (it must be {}); correct it", &row - table.data() + 1,
                                   row[2], density_range.words()));
  return populations(table);
}

Key length_key(const char* name, const char* example, const char* meaning) {
  return {.path = name,
          .type = KeyType::number,
          .example = example,
          .unit = "m",
          .meaning = meaning,
          .range = radius_range};
}

} // namespace

SizeLaw equal_sizes(double radius) {
  assert(radius > 0.0);
  return {radius, radius, 0, [=](int k) { return std::pow(radius, k); }, [=](double, std::size_t) { return radius; }};
}

SizeLaw power_sizes(double exponent, double min, double max) {
  assert(min > 0.0 && min < max);
  return {min, max, 0,
          [=](int k) { return power_integral(k - exponent, min, max) / power_integral(-exponent, min, max); },
          [=](double u, std::size_t) { return power_quantile(exponent, min, max, u); }};
}

SizeLaw listed_sizes(std::vector<double> radii) {
  assert(!radii.empty());
  const auto [smallest, largest] = std::minmax_element(radii.begin(), radii.end());
  SizeLaw law{*smallest, *largest, radii.size(), {}, {}};
  law.mean_power = [radii](int k) {
    double sum = 0.0;
    for (const double radius : radii)
      sum += std::pow(radius, k);
    return sum / static_cast<double>(radii.size());
  };
  law.radius = [radii = std::move(radii)](double, std::size_t k) { return radii[k % radii.size()]; };
  return law;
}

SizeLaw tabulated_sizes(NumberRows table) {
  assert(!table.empty());
  double total = 0.0, smallest = table.front()[0], largest = smallest;
  for (std::vector<double>& row : table) {
    smallest = std::min(smallest, row[0]);
    largest = std::max(largest, row[0]);
    assert(row.size() == 2 && row[1] > 0.0);
    row[1] = total += row[1]; // cumulative
  }
  SizeLaw law{smallest, largest, table.size(), {}, {}};
  law.mean_power = [table, total](int k) {
    double sum = 0.0, before = 0.0;
    for (const std::vector<double>& row : table) {
      sum += (row[1] - before) * std::pow(row[0], k);
      before = row[1];
    }
    return sum / total;
  };
  law.radius = [table = std::move(table), total](double u, std::size_t) {
    const auto row = std::upper_bound(table.begin(), table.end() - 1, u * total,
                                      [](double number, const std::vector<double>& r) { return number < r[1]; });
    return (*row)[0];
  };
  return law;
}

SizeLaw populations(const NumberRows& table) {
  NumberRows sizes, densities;
  double volume = 0.0, mass = 0.0;
  for (const std::vector<double>& row : table) {
    assert(row.size() == 3);
    sizes.push_back({row[0], row[1]});
    densities.push_back({row[2], row[1]});
    volume += row[1] * std::pow(row[0], 3);
    mass += row[1] * std::pow(row[0], 3) * row[2];
  }
  SizeLaw law = tabulated_sizes(std::move(sizes));
  law.density = tabulated_sizes(std::move(densities)).radius; // equal quantiles select equal rows
  law.mean_density = mass / volume;
  return law;
}

namespace {

// Returns the position of k in a random permutation of [0, count), computed independently for each k: a Feistel network
// over the bits of count, applied repeatedly while the result is too large (cycle walking, Black & Rogaway 2002). It
// has eight rounds because the halves of a small count have few bits.
std::size_t shuffled(std::size_t k, std::size_t count, std::uint64_t seed) {
  assert(k < count);
  const auto bits = static_cast<unsigned>(std::bit_width(count - 1));
  const unsigned low_bits = bits - bits / 2;
  const std::size_t low_mask = (std::size_t{1} << low_bits) - 1, high_mask = (std::size_t{1} << (bits / 2)) - 1;
  const auto noise = [&](std::size_t round, std::size_t half) {
    return static_cast<std::size_t>(0x1p32 * RandomStream(seed, RandomPurpose::shuffle, round << 32 | half).uniform());
  };
  do {
    std::size_t high = k >> low_bits, low = k & low_mask;
    for (std::size_t round = 0; round < 8; round += 2) {
      high ^= noise(round, low) & high_mask;
      low ^= noise(round + 1, high) & low_mask;
    }
    k = high << low_bits | low;
  } while (k >= count);
  return k;
}

} // namespace

double DrawnSizes::value(const std::function<double(double u, std::size_t k)>& quantile, std::size_t particle) const {
  const std::size_t k = shuffled(particle, count_, seed_);
  RandomStream random(seed_, RandomPurpose::size, k);
  return quantile((static_cast<double>(k) + random.uniform()) / static_cast<double>(count_), k);
}

double DrawnSizes::radius(std::size_t particle) const {
  return law_.smallest == law_.largest ? law_.smallest : value(law_.radius, particle);
}

double DrawnSizes::density(std::size_t particle) const {
  assert(has_densities());
  return value(law_.density, particle);
}

std::vector<double> draw_radii(const SizeLaw& law, std::size_t count, std::uint64_t seed) {
  const DrawnSizes sizes(law, count, seed);
  std::vector<double> radii(count);
  for (std::size_t k = 0; k < count; ++k)
    radii[k] = sizes.radius(k);
  return radii;
}

namespace {

std::vector<SizeEntry> keeler_size_laws() {
  return {
      {"equal",
       {length_key("radius", "1.0", "radius of every particle")},
       [](const Parameters& p) { return equal_sizes(p.number("radius")); }},
      {"power",
       {{.path = "exponent",
         .type = KeyType::number,
         .example = "2.9",
         .unit = "1",
         .meaning = "q of the power law n(r) dr ~ r^-q dr",
         .range = {.low = -10, .high = 10}},
        length_key("min", "0.5", "smallest radius of the power law"),
        length_key("max", "5.0", "largest radius of the power law")},
       make_power},
      {"file",
       {{.path = "path",
         .type = KeyType::rows,
         .example = "\"radii.txt\"",
         .meaning = "the radii, drawn in turn",
         .range = radius_range,
         .columns = {"radius in m"}}},
       make_listed},
      {"table",
       {{.path = "table",
         .type = KeyType::rows,
         .example = "[[30.0, 1], [1.0, 19999]]",
         .meaning = "radii, and how many particles have each, in proportion",
         .range = {.low = 1e-6, .high = 1e9},
         .columns = {"radius in m", "number of particles"}}},
       make_table},
      {"populations",
       {{.path = "populations",
         .type = KeyType::rows,
         .example = "[[30.0, 1, 450.0], [1.0, 19999, 900.0]]",
         .meaning = "radii, how many particles have each, in proportion, and of which density",
         .range = {.low = 1e-6, .high = 1e9},
         .alternatives = {"particles.density"},
         .columns = {"radius in m", "number of particles", "density in kg/m^3"}}},
       make_populations},
  };
}

Registry<SizeEntry>& registered_size_laws() {
  static Registry<SizeEntry> laws("size law", &SizeEntry::name, keeler_size_laws(), KeyTable::shared);
  return laws;
}

} // namespace

void require_consistent(const SizeLaw& law) {
  const auto require = [&](double radius, const std::string& what) {
    if (!(radius >= law.smallest * (1.0 - 1e-9) && radius <= law.largest * (1.0 + 1e-9)))
      throw UsageError(fmt::format("{} is {:g} m, outside the limits of the law, {:g} m to {:g} m; correct the law",
                                   what, radius, law.smallest, law.largest));
  };
  if (!(law.smallest > 0.0 && law.smallest <= law.largest && std::isfinite(law.largest)))
    throw UsageError(
        fmt::format("radii from {:g} m to {:g} m are no sizes; correct the law", law.smallest, law.largest));
  for (const double u : {1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9})
    require(law.radius(u, 0), fmt::format("the radius at the quantile {:g}", u));
  for (const int k : {1, 2, 3, 6})
    require(std::pow(law.mean_power(k), 1.0 / k), fmt::format("the root of the mean power {}", k));
}

void add_size_law(SizeEntry entry, IfTaken if_taken) {
  registered_size_laws().add(std::move(entry), if_taken);
}

const std::vector<SizeEntry>& size_laws() {
  return registered_size_laws().entries();
}

} // namespace keeler::particles
