// What sweeps and studies measure in each finished run: columns of their tables, made of the quantities of keeler
// analyze and of the columns of series.csv. Names, units and meanings are theirs.
#pragma once

#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// A quantity in one unit.
struct RunColumn {
  std::string name, error_name; ///< NAME_UNIT and NAME_error_UNIT, as `keeler analyze` names them
  std::string meaning;          ///< with its unit
};

struct RunNumbers {
  std::size_t particle_count = 0;
  std::optional<double> since_orbit, until_orbit; ///< none: the series is too short for a mean
  bool steady = false;
  std::vector<std::optional<Estimate>> values; ///< in the order of the columns; none: not measured. Error NaN: unknown
};

/// The numbers of every batch, and others of keeler analyze that are asked for by name.
class RunQuantities {
public:
  /// A name as Quantity::is_called() takes it. Throws UsageError for one that keeler analyze does not have, or that is
  /// no plain number.
  explicit RunQuantities(const std::vector<std::string>& more = {});

  const std::vector<RunColumn>& columns() const { return columns_; }
  /// The place of the column of that name; none where there is none.
  std::optional<std::size_t> find(const std::string& name) const;

  /// Of a finished run: means over its rows from orbit `since` on, or over the part that is steady, and over the
  /// snapshots there. Throws IoError.
  RunNumbers measure(const std::filesystem::path& folder, const Scene& scene, std::optional<double> since) const;

  struct Source; ///< what is read of a run

private:
  using Reading = std::function<std::optional<Estimate>(const Source&)>;

  void add(const Quantity& quantity, const Reading& number);
  void add_measured(const Quantity& quantity, const std::function<const Record&(const Source&)>& record);
  void add_series_mean(const std::string& column, Quantity quantity);

  std::vector<RunColumn> columns_;
  std::vector<Reading> readings_;
  bool analyzes_ = false; ///< something is asked for that needs all that keeler analyze measures
};

} // namespace keeler
