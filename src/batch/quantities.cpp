#include <keeler/batch/quantities.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/clusters.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>
#include <keeler/diagnostics/wake_geometry.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/stored_patches.hpp>
#include <keeler/runs/transport.hpp>

#include <functional>
#include <limits>
#include <span>

namespace keeler {
namespace {

namespace fs = std::filesystem;
using Maybe = std::optional<Estimate>;

// A finished run, as far as its numbers need it.
struct Measurements {
  SeriesTable series;
  Patch last;
  Transport transport;
  std::vector<std::size_t> rows; // of the window
  std::optional<WakeGeometry> wakes;
};

struct Quantity {
  QuantityName name;
  std::function<Maybe(const Measurements&)> of;
};

Maybe over(const Maybe& estimate, double unit) {
  return estimate ? Maybe({estimate->value / unit, estimate->error / unit}) : std::nullopt;
}

double radius_speed(const Measurements& m) {
  return mean_radius(m.last) * m.last.orbital_frequency;
}

double radius_viscosity(const Measurements& m) {
  return mean_radius(m.last) * radius_speed(m);
}

double gravity_viscosity(const Measurements& m) {
  const double omega = m.last.orbital_frequency, g_sigma = newton_g_si * surface_density(m.last);
  return g_sigma * g_sigma / (omega * omega * omega);
}

Maybe column_mean(const Measurements& m, const std::string& column) {
  const std::vector<double>* const all = m.series.find(column);
  if (!all)
    return std::nullopt;
  std::vector<double> values;
  for (const std::size_t row : m.rows)
    values.push_back((*all)[row]);
  return block_mean(values);
}

// Of each particle and in each orbit: a collision is one of two particles.
Maybe collision_rate(const Measurements& m) {
  const std::vector<double>&orbits = m.series.of("time_orbits"), &collisions = m.series.of("collisions");
  std::vector<double> rates;
  for (std::size_t k = 0; k + 1 < m.rows.size(); ++k) {
    const std::size_t a = m.rows[k], b = m.rows[k + 1];
    rates.push_back(2.0 * (collisions[b] - collisions[a]) /
                    (static_cast<double>(m.last.size()) * (orbits[b] - orbits[a])));
  }
  return block_mean(rates);
}

// Of the snapshots as a whole: how far their mean is off is not known.
Maybe wake_number(const Measurements& m, const std::function<std::optional<double>(const WakeGeometry&)>& number) {
  const std::optional<double> value = m.wakes ? number(*m.wakes) : std::nullopt;
  return value ? Maybe({*value, std::numeric_limits<double>::quiet_NaN()}) : std::nullopt;
}

// At one instant: how far it is off is not known.
Maybe largest_cluster(const Measurements& m) {
  if (!m.wakes)
    return std::nullopt;
  const ClusterAnalysis clusters = analyze_clusters(std::span(&m.last, 1), default_cluster_gap);
  return Maybe({clusters.largest_mass_share, std::numeric_limits<double>::quiet_NaN()});
}

void add_viscosity(std::vector<Quantity>& all, const std::string& part, const std::string& meaning,
                   const std::function<Maybe(const Transport&)>& of) {
  const std::string name = part + "_viscosity";
  all.push_back({{name, "m2_s", meaning + ", m²/s"}, [of](const Measurements& m) { return of(m.transport); }});
  all.push_back({{name, "r2_omega", "the same in r² Ω"},
                 [of](const Measurements& m) { return over(of(m.transport), radius_viscosity(m)); }});
  all.push_back({{name, "g2_sigma2_omega3", "the same in G²Σ²/Ω³"},
                 [of](const Measurements& m) { return over(of(m.transport), gravity_viscosity(m)); }});
}

std::vector<Quantity> make_quantities() {
  std::vector<Quantity> all;
  add_viscosity(all, "translational", "viscosity by particles that move",
                [](const Transport& t) -> Maybe { return t.translational; });
  add_viscosity(all, "collisional", "viscosity by contacts", [](const Transport& t) -> Maybe { return t.collisional; });
  add_viscosity(all, "gravitational", "viscosity by self-gravity", [](const Transport& t) { return t.gravitational; });
  add_viscosity(all, "total", "viscosity of the three", [](const Transport& t) { return t.total; });
  add_viscosity(all, "loss", "what the total must be by the loss of energy",
                [](const Transport& t) -> Maybe { return t.from_loss; });
  all.push_back({{"energy_balance", "", "the latter over the total: 1 when nothing else does work"},
                 [](const Measurements& m) { return m.transport.balance; }});
  for (const char axis : {'x', 'y', 'z'}) {
    const std::string name = std::string("dispersion_") + axis, column = name + "_m_s";
    all.push_back({{name, "m_s", std::string("velocity dispersion along ") + axis + ", m/s"},
                   [column](const Measurements& m) { return column_mean(m, column); }});
    all.push_back({{name, "r_omega", "the same in mean r Ω"},
                   [column](const Measurements& m) { return over(column_mean(m, column), radius_speed(m)); }});
  }
  all.push_back(
      {{"dispersion_without_waves_x", "m_s", "velocity dispersion along x without box-long epicyclic waves, m/s"},
       [](const Measurements& m) { return column_mean(m, "dispersion_without_waves_x_m_s"); }});
  all.push_back({{"epicyclic_wave_fraction", "", "fraction of the epicyclic energy in these waves"},
                 [](const Measurements& m) { return column_mean(m, "epicyclic_wave_fraction"); }});
  all.push_back(
      {{"scale_height", "m", "√⟨z²⟩, m"}, [](const Measurements& m) { return column_mean(m, "scale_height_m"); }});
  for (const QuantityName& name : {QuantityName{"mean_spin", "omega", "about the vertical, Ω; with friction"},
                                   QuantityName{"spin_energy_ratio", "", "of spins and random motion; with friction"}})
    all.push_back({name, [column = name.column()](const Measurements& m) { return column_mean(m, column); }});
  all.push_back({{"collisions_per_particle_orbit", "", "collisions faster than v_cut"}, collision_rate});
  const auto add_wakes = [&](const QuantityName& name,
                             const std::function<std::optional<double>(const WakeGeometry&)>& number) {
    all.push_back({name, [number](const Measurements& m) { return wake_number(m, number); }});
  };
  add_wakes({"wake_amplitude", "", "of the mean autocorrelation; with self-gravity"},
            [](const WakeGeometry& w) { return w.mean.amplitude; });
  add_wakes({"wake_wavelength", "m", "λ_⊥, power-weighted; with wakes"},
            [](const WakeGeometry& w) { return w.wavelength.value; });
  add_wakes({"wake_angle", "degrees", "between the wakes and the orbit by the power spectrum; with wakes"},
            [](const WakeGeometry& w) { return w.angle_degrees.value; });
  all.push_back({{"largest_cluster_mass_share", "", "of touching spheres, in the last snapshot; with self-gravity"},
                 largest_cluster});
  add_wakes({"wake_contrast", "",
             "rms of the smoothed surface density about its mean, over the mean; with "
             "self-gravity"},
            [](const WakeGeometry& w) { return w.contrast; });
  return all;
}

const std::vector<Quantity>& all_quantities() {
  static const std::vector<Quantity> all = make_quantities();
  return all;
}

// None: the series has too few rows for a mean.
std::optional<Transport> transport_in(const SeriesTable& series, const RingScale& scale, std::optional<double> since) {
  if (!enough_rows(series))
    return std::nullopt;
  try {
    return transport(series, scale, {since, std::nullopt});
  } catch (const UsageError&) {
    return std::nullopt;
  }
}

std::vector<std::size_t> rows_between(const std::vector<double>& orbits, double since, double until) {
  constexpr double rounding = 1e-9;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < orbits.size(); ++k)
    if (orbits[k] >= since - rounding && orbits[k] <= until + rounding)
      rows.push_back(k);
  return rows;
}

// With the mean wavelength of these snapshots, as `keeler analyze` takes it.
WakeGeometry wakes_in(const fs::path& folder, const Patch& last, double since) {
  const StoredPatches stored = load_patches(folder, std::max(0.0, last.time_orbits - since));
  const double share = 1.0 / static_cast<double>(stored.patches.size());
  double wavelength = 0.0;
  for (const Patch& patch : stored.patches)
    wavelength += share * critical_wavelength(patch);
  return wake_geometry(stored.patches, wavelength);
}

} // namespace

const std::vector<QuantityName>& quantities() {
  static const std::vector<QuantityName> names = [] {
    std::vector<QuantityName> list;
    for (const Quantity& quantity : all_quantities())
      list.push_back(quantity.name);
    return list;
  }();
  return names;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const QuantityName& name : quantities())
    names.push_back(name.column());
  return names;
}

RunNumbers measure_run(const fs::path& folder, const Scene& scene, std::optional<double> since) {
  RunNumbers numbers;
  numbers.values.resize(all_quantities().size());
  Measurements m;
  m.series = read_series(folder / "series.csv");
  m.last = std::move(load_newest_patch(folder).patches.front());
  numbers.particle_count = m.last.size();
  const std::optional<Transport> found =
      transport_in(m.series, RingScale::of(m.last, !scene.external_forces.empty()), since);
  if (!found)
    return numbers;
  m.transport = *found;
  m.rows = rows_between(m.series.of("time_orbits"), found->since_orbit, found->until_orbit);
  if (scene.gravity)
    m.wakes = wakes_in(folder, m.last, found->since_orbit);
  numbers.since_orbit = found->since_orbit;
  numbers.until_orbit = found->until_orbit;
  numbers.steady = found->steady;
  for (std::size_t k = 0; k < numbers.values.size(); ++k)
    numbers.values[k] = all_quantities()[k].of(m);
  return numbers;
}

} // namespace keeler
