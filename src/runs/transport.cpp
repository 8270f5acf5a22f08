#include <keeler/runs/transport.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/mean.hpp>
#include <keeler/diagnostics/viscosity.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

namespace keeler::runs {
namespace {

using Values = std::vector<double>;

constexpr std::size_t min_rows = 3;                          // for a viscosity
constexpr std::size_t min_for_steady = 8;                    // to detect where a run becomes steady
constexpr double min_orbits = 2.0, min_fraction = 1.0 / 3.0; // of a part that may count as steady
constexpr double small_waves = 0.02;                         // fraction of the energy; 1 % of the dispersion

// Returns true if the run had self-gravity and its stress was measured.
bool measures_gravity(const io::SeriesTable& series) {
  return series.find("potential_energy_j") != nullptr;
}

// Returns the rows at which all quantities were measured.
std::vector<std::size_t> complete_rows(const io::SeriesTable& series) {
  std::vector<std::size_t> rows;
  const Values* const potential = series.find("potential_energy_j");
  for (std::size_t k = 0; k < series.rows(); ++k)
    if (!potential || std::isfinite((*potential)[k]))
      rows.push_back(k);
  return rows;
}

// Rates between successive complete rows, all as viscosities: m²/s.
struct Rates {
  Values time;                                      // middle of each interval, orbits
  Values translational, collisional, gravitational; // the last is empty if not measured
  Values total, loss;

  std::size_t size() const { return time.size(); }
};

Rates rates_of(const io::SeriesTable& series, const std::vector<std::size_t>& rows, const RingScale& scale) {
  const Values& orbits = series.of("time_orbits");
  const Values &translational = series.of("translational_flux_kg_m2_s"),
               &collisional = series.of("collisional_flux_kg_m2_s");
  const Values &lost = series.of("energy_lost_j"), &random = series.of("random_energy_j");
  const Values *const stress = series.find("gravitational_viscosity_m2_s"),
                      *const potential = series.find("potential_energy_j"),
                      *const drift = series.find("drift_viscosity_m2_s");
  const double s = scale.shear * scale.orbital_frequency;
  assert(s > 0.0 && scale.mass > 0.0 && std::is_sorted(rows.begin(), rows.end()));
  Rates rates;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const std::size_t a = rows[k], b = rows[k + 1];
    const double time = (orbits[b] - orbits[a]) * 2.0 * pi / scale.orbital_frequency;
    const double flux = 1.0 / (scale.mass * s * time);
    rates.time.push_back(0.5 * (orbits[a] + orbits[b]));
    rates.translational.push_back((translational[b] - translational[a]) * flux);
    if (drift) // it changes slowly, or is a free epicycle, and then the rows average over it
      rates.translational.back() -= 0.5 * ((*drift)[a] + (*drift)[b]);
    rates.collisional.push_back((collisional[b] - collisional[a]) * flux);
    double total = rates.translational.back() + rates.collisional.back();
    double loss = lost[b] - lost[a] + random[b] - random[a];
    if (potential) {
      rates.gravitational.push_back(0.5 * ((*stress)[a] + (*stress)[b]));
      total += rates.gravitational.back();
      loss += (*potential)[b] - (*potential)[a];
    }
    rates.total.push_back(total);
    rates.loss.push_back(diagnostics::loss_viscosity(loss, scale.mass, s, time));
  }
  return rates;
}

// Returns the rows within the window.
std::vector<std::size_t> within(const std::vector<std::size_t>& rows, const Values& orbits, double since,
                                double until) {
  constexpr double rounding = 1e-9;
  std::vector<std::size_t> chosen;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(chosen),
               [&](std::size_t k) { return orbits[k] >= since - rounding && orbits[k] <= until + rounding; });
  return chosen;
}

// Returns the ratio of the means. Its error is from the residuals above − ratio · below, since both fluctuate together.
Estimate ratio_of(const Values& above, const Values& below) {
  assert(above.size() == below.size());
  const double ratio =
      std::accumulate(above.begin(), above.end(), 0.0) / std::accumulate(below.begin(), below.end(), 0.0);
  Values rest(above.size());
  for (std::size_t k = 0; k < above.size(); ++k)
    rest[k] = above[k] - ratio * below[k];
  return {ratio, statistics::block_mean(rest).error / std::fabs(statistics::block_mean(below).value)};
}

// Returns none if the ratio is meaningless: smaller than its error, or 0/0.
std::optional<Estimate> balance_of(const Rates& rates) {
  const Estimate ratio = ratio_of(rates.loss, rates.total);
  if (!std::isfinite(ratio.value) || ratio.error >= std::fabs(ratio.value))
    return std::nullopt;
  return ratio;
}

Values values_at(const Values& column, const std::vector<std::size_t>& rows) {
  Values values;
  for (const std::size_t k : rows)
    values.push_back(column[k]);
  return values;
}

bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// Returns c_x without box-long waves, which keep growing when the random motion is steady. Series of earlier versions
// or of few particles have only the dispersion about the mean motion.
Values random_motion(const io::SeriesTable& series, const std::vector<std::size_t>& rows) {
  if (const Values* const without_waves = series.find("dispersion_without_waves_x_m_s"))
    if (Values values = values_at(*without_waves, rows); all_finite(values))
      return values;
  return values_at(series.of("dispersion_x_m_s"), rows);
}

std::optional<WaveGrowth> waves_in(const io::SeriesTable& series, const std::vector<std::size_t>& rows) {
  constexpr double max_sigmas = 3.0;
  const Values* const column = series.find("epicyclic_wave_fraction");
  if (!column || rows.size() < min_for_steady)
    return std::nullopt;
  const Values fractions = values_at(*column, rows);
  if (!all_finite(fractions))
    return std::nullopt;
  const std::span<const double> all(fractions);
  const std::size_t half = all.size() / 2;
  WaveGrowth waves{statistics::block_mean(all.first(half)), statistics::block_mean(all.last(half))};
  const double first = waves.first_half.value, last = waves.last_half.value;
  waves.steady = std::max(first, last) < small_waves ||
                 std::fabs(last - first) <= max_sigmas * std::hypot(waves.first_half.error, waves.last_half.error);
  return waves;
}

// A single particle has no dispersion: its energy changes are the rounding of its forces.
bool moves_at_random(const io::SeriesTable& series, const std::vector<std::size_t>& rows) {
  const Values dispersions = values_at(series.of("dispersion_x_m_s"), rows);
  return std::any_of(dispersions.begin(), dispersions.end(), [](double c) { return c > 0.0; });
}

} // namespace

RingScale RingScale::of(const Patch& patch, bool driven, bool attracts) {
  return {diagnostics::total_mass(patch), patch.orbital_frequency, patch.box.shear, driven, attracts};
}

bool enough_rows(const io::SeriesTable& series) {
  return series.find("translational_flux_kg_m2_s") && complete_rows(series).size() >= min_rows;
}

double steady_since(const io::SeriesTable& series, double until) {
  const Values& orbits = series.of("time_orbits");
  const std::vector<std::size_t> rows = within(complete_rows(series), orbits, -HUGE_VAL, until);
  if (rows.size() < min_for_steady)
    return orbits.empty() ? 0.0 : orbits.front();
  const Rates rates = rates_of(series, rows, {.mass = 1.0, .orbital_frequency = 1.0, .shear = 1.0});
  std::size_t start =
      std::max(statistics::steady_start(rates.loss), statistics::steady_start(random_motion(series, rows)));
  if (!rates.gravitational.empty())
    start = std::max(start, statistics::steady_start(rates.gravitational));
  return orbits[rows[std::min(start, rows.size() - min_for_steady)]];
}

Transport transport(const io::SeriesTable& series, const RingScale& scale, const OrbitWindow& window) {
  const Values& orbits = series.of("time_orbits");
  Transport result;
  const double until = window.until ? *window.until : orbits.empty() ? 0.0 : orbits.back();
  const double since = window.since ? *window.since : steady_since(series, until);
  const std::vector<std::size_t> rows = within(complete_rows(series), orbits, since, until);
  result.since_found = !window.since && rows.size() >= min_for_steady;
  if (rows.size() < min_rows)
    throw UsageError(
        fmt::format("the series has {} between orbits {:.6g} and {:.6g}, too few for a viscosity; choose a "
                    "longer part of the run",
                    rows.size() == 1 ? "1 row" : fmt::format("{} rows", rows.size()), since, until));
  const Rates rates = rates_of(series, rows, scale);
  result.since_orbit = orbits[rows.front()];
  result.until_orbit = orbits[rows.back()];
  result.intervals = rates.size();
  result.translational = statistics::block_mean(rates.translational);
  result.collisional = statistics::block_mean(rates.collisional);
  result.from_loss = statistics::block_mean(rates.loss);
  const bool complete = measures_gravity(series) || !scale.attracts;
  if (measures_gravity(series))
    result.gravitational = statistics::block_mean(rates.gravitational);
  else if (complete)
    result.gravitational = Estimate{};
  if (complete) {
    result.total = statistics::block_mean(rates.total);
    if (!scale.driven && moves_at_random(series, rows))
      result.balance = balance_of(rates);
  }
  result.waves = waves_in(series, rows);
  const double length = result.until_orbit - result.since_orbit;
  result.steady = length >= min_orbits && length >= min_fraction * (until - orbits.front()) &&
                  statistics::is_steady(rates.loss) && statistics::is_steady(random_motion(series, rows));
  return result;
}

} // namespace keeler::runs
