#include <keeler/runs/measured_part.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::runs {
namespace {

constexpr double averaged_orbits = 1.0; // if no steady part was detected

} // namespace

MeasuredPart measured_part(const std::filesystem::path& path, const OrbitWindow& window) {
  if (std::isnan(window.since.value_or(0.0)) || std::isnan(window.until.value_or(0.0)))
    throw UsageError("--since or --until is not a number (a part of a run lies between two orbits); give orbits");
  if (!std::filesystem::is_directory(path)) {
    if (window.since || window.until)
      throw UsageError(fmt::format("--since and --until choose a part of a run, and '{}' is a snapshot; give the run's "
                                   "folder",
                                   path.string()));
    StoredPatches snapshot = load_newest_patch(path);
    const TransportReport report = TransportReport::of_snapshot(snapshot.patches.front(), snapshot.gravity);
    return {std::move(snapshot), report};
  }
  const StoredPatches newest = load_newest_patch(path);
  const Patch& last = newest.patches.front();
  const TransportReport report =
      TransportReport::of_run(path, RingScale::of(last, newest.driven, newest.gravity.has_value()), window);
  const std::optional<Transport>& found = report.transport();
  const double since = found && found->since_found ? found->since_orbit : last.time_orbits - averaged_orbits;
  if (window.since || window.until)
    return {load_patches_between(path, window.since.value_or(since), window.until.value_or(last.time_orbits)), report};
  return {load_patches(path, std::max(0.0, last.time_orbits - since)), report};
}

} // namespace keeler::runs
