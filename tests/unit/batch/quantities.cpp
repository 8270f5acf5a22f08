#include <keeler/batch/quantities.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/series.hpp>
#include <keeler/runs/measured_part.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/run.hpp>
#include <keeler/runs/summary.hpp>

#include "unit/files/disk.hpp"
#include "unit/runs/scenes.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace quantities_test {

using namespace keeler;
using namespace keeler::batch;

TEST_CASE("every number of a batch has a name of its own; docs/formats.md has the table") {
  std::set<std::string> names;
  std::string table = "| column | its error | meaning |\n|---|---|---|\n";
  const RunQuantities quantities;
  for (const RunColumn& column : quantities.columns()) {
    CHECK(names.insert(column.name).second);
    CHECK(names.insert(column.error_name).second);
    table += fmt::format("| `{}` | `{}` | {} |\n", column.name, column.error_name, column.meaning);
  }
  const std::string page = files::read_text(KEELER_SOURCE_DIR "/docs/formats.md");
  INFO("docs/formats.md must hold this table:\n" << table);
  CHECK(page.find(table) != page.npos);
}

TEST_CASE("others of keeler analyze are columns behind them, a vector three") {
  const std::size_t usual = RunQuantities().columns().size();
  const RunQuantities more({"local_toomre_q", "local_dispersion", "total_viscosity", "clusters.count"});
  REQUIRE(more.columns().size() == usual + 5);
  CHECK(more.columns()[usual].name == "local_toomre_q");
  CHECK(more.columns()[usual + 2].name == "local_dispersion_y_m_s");
  CHECK(more.find("clusters.count") == usual + 4);
  CHECK_FALSE(RunQuantities().find("clusters.count"));
  CHECK_THROWS_WITH_AS(RunQuantities({"toomreq"}), "there is no number 'toomreq' here; did you mean 'toomre_q'?",
                       UsageError);
}

TEST_CASE("every number of a run can be a column, with the value that its own table has") {
  const test::TemporaryFolder work;
  const Scene scene = test::small_scene({"output.series_every=0.05", "output.stress_every=0.05"});
  runs::RunRequests requests;
  runs::RunOptions options;
  options.folder = work / "run";
  start_run(scene, options, requests);

  std::vector<std::string> names;
  for (const quantities::Quantity& quantity : RunQuantities::known()) {
    CAPTURE(quantity.name);
    if (quantity.shape == quantities::Shape::other) // words and lists; some share a name with a number of another table
      continue;
    const RunQuantities one({quantity.name});
    CHECK((one.find(quantity.name) || one.find(quantity.along(2).name)));
    names.push_back(quantity.name);
  }
  REQUIRE(names.size() > 120);
  const RunQuantities all(names);
  const RunNumbers numbers = all.measure(options.folder, scene, 0.25);
  const auto value = [&](const std::string& name) { return numbers.values[all.find(name).value()]; };
  const runs::MeasuredPart part = runs::measured_part(options.folder, {0.25, std::nullopt});
  const quantities::Record analysis = record_of(measure(part.stored.patches, part.transport));
  const quantities::Record summary = runs::read_summary(options.folder);
  std::size_t compared = 0;
  const std::set<std::string> usual = {"epicyclic_wave_fraction", "scale_height", "collisions_per_particle_orbit"};
  for (const quantities::Record* const record : {&analysis, &summary})
    for (const quantities::Entry& entry : record->entries) {
      const std::string& name = entry.quantity.name;
      CAPTURE(name);
      const std::optional<double> number = number_in(*record, name);
      const bool hidden = record != &analysis && find_value(analysis, name);
      if (!number || hidden || usual.contains(name)) // every batch has the usual ones, of its own
        continue;
      CHECK(value(name).value().value == *number);
      ++compared;
    }
  CHECK(compared > 80);
  CHECK(value("finished")->value == 1.0);
  const io::SeriesTable series = io::read_series(options.folder / "series.csv");
  const std::vector<double>&times = series.of("time_orbits"), &slow = series.of("slow_contacts");
  const auto first = static_cast<std::size_t>(
      std::find_if(times.begin(), times.end(), [](double t) { return t > 0.2499; }) - times.begin());
  CHECK(value("slow_contacts_per_orbit")->value ==
        doctest::Approx((slow.back() - slow[first]) / (times.back() - times[first])));
  CHECK_THROWS_AS(RunQuantities({"size_classes"}), UsageError);
}

TEST_CASE("with units asked for, velocities and viscosities have one column each, also by their other names") {
  const RunQuantities all, gravity({}, quantities::UnitSystem::gravity);
  CHECK(gravity.columns().size() < all.columns().size());
  CHECK(gravity.find("total_viscosity_g2_sigma2_omega3"));
  CHECK(gravity.find("total_viscosity_m2_s") == gravity.find("total_viscosity_g2_sigma2_omega3"));
  CHECK(gravity.columns()[gravity.find("dispersion_x").value()].name == "dispersion_x_g_sigma_omega");
  CHECK(gravity.find("scale_height_m"));
  CHECK(all.find("total_viscosity_r2_omega") != all.find("total_viscosity_m2_s"));
}

} // namespace quantities_test
