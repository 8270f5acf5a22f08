// The quantities that sweeps and studies measure in each finished run, as columns of their tables. Names, units and
// meanings are taken from keeler analyze, summary.json and the columns of series.csv.
#pragma once

#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::batch {

/// A quantity in one unit.
struct RunColumn {
  std::string name, error_name; ///< NAME_UNIT and NAME_error_UNIT, as `keeler analyze` names them
  std::string meaning;          ///< including the unit
  quantities::Quantity quantity;
};

struct RunNumbers {
  std::size_t particle_count = 0;
  std::optional<double> since_orbit, until_orbit; ///< measured part; none: the series is too short for a mean
  bool steady = false;
  std::vector<std::optional<Estimate>> values; ///< one per column; none: not measured; NaN error: unknown
};

/// The default quantities of every batch, and further ones of a run, requested by name.
class RunQuantities {
public:
  /// Names are matched by Quantity::is_called(), first with the numbers of keeler analyze, then of summary.json, then
  /// of series.csv (means; rates per orbit of what accumulates). Truth values count as 1 and 0. `units`: the units of
  /// velocities and viscosities; none: the forms of each quantity. Throws UsageError for a name that no number has, or
  /// that is not a plain number.
  explicit RunQuantities(const std::vector<std::string>& extra = {},
                         std::optional<quantities::UnitSystem> units = std::nullopt);

  /// Returns the numbers that can be requested, and the words and lists that cannot.
  static std::vector<quantities::Quantity> known();

  const std::vector<RunColumn>& columns() const { return columns_; }
  /// Returns the index of the column with that name, or of the first with this name in other units
  /// or per orbit; none if there is none.
  std::optional<std::size_t> find(const std::string& name) const;

  /// Measures a finished run: means over the rows and snapshots from orbit `since` on, by default over the steady part.
  /// Throws IoError.
  RunNumbers measure(const std::filesystem::path& folder, const Scene& scene, std::optional<double> since) const;

  struct Source; ///< the data read from a run

private:
  using Reading = std::function<std::optional<Estimate>(const Source&)>;

  bool add_named(const std::string& name, std::span<const quantities::Quantity> all,
                 quantities::Record Source::*record);
  bool add_column_of_series(const std::string& name);
  void add(const quantities::Quantity& quantity, const Reading& number);
  void add_measured(const quantities::Quantity& quantity, quantities::Record Source::*record);
  void add_series_mean(const std::string& column, quantities::Quantity quantity);

  std::optional<quantities::UnitSystem> units_;
  std::vector<RunColumn> columns_;
  std::vector<Reading> readings_;
  bool analyzes_ = false;   ///< a requested quantity needs the full analysis
  bool summarises_ = false; ///< a requested quantity is of summary.json
};

} // namespace keeler::batch
