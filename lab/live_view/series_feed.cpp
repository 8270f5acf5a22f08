#include "series_feed.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/run_report/series_plots.hpp>
#include <keeler/runs/series_columns.hpp>

#include <cassert>

namespace keeler::live_view {

void SeriesFeed::sample(const Simulation& simulation, const Scene& scene) {
  assert(is_sampled());
  const auto step = static_cast<double>(simulation.state().step);
  if (table_.rows() > 0 && table_.columns.front().back() == step)
    return;
  throttle_.spend([&] {
    const std::vector<runs::SeriesColumn> columns = runs::series_columns_of(scene);
    if (table_.names.empty()) {
      table_.names = runs::names_of(columns);
      table_.names.insert(table_.names.begin(), "step");
      table_.columns.resize(table_.names.size());
    }
    const runs::SeriesSample now(scene, simulation);
    const std::vector<double> values = runs::values_of(columns, now);
    table_.columns.front().push_back(step);
    for (std::size_t k = 0; k < values.size(); ++k)
      table_.columns[k + 1].push_back(values[k]);
    scale_ = runs::RingScale{.mass = now.means.mass,
                             .orbital_frequency = scene.planet.orbital_frequency,
                             .shear = simulation.state().box.shear,
                             .driven = !scene.external_forces.empty(),
                             .attracts = scene.gravity.has_value()};
  });
}

void SeriesFeed::refresh(const std::optional<runs::RingScale>& scale) {
  if (is_sampled() || !throttle_.due())
    return;
  throttle_.spend([&] {
    const std::filesystem::path file = folder_ / "series.csv";
    try {
      if (std::filesystem::exists(file))
        table_ = io::read_series(file);
      scale_ = scale;
    } catch (const Error&) { // as while a new run begins in the folder
      table_ = {};
    }
  });
}

std::shared_ptr<const std::string> SeriesFeed::text() {
  if (scale_ && table_.rows() > 1 && table_.rows() != written_rows_ && writing_.due())
    writing_.spend([&] {
      text_ =
          std::make_shared<std::string>(json_text(json_of(run_report::series_plots(table_, *scale_, std::nullopt))));
      written_rows_ = table_.rows();
    });
  return text_;
}

} // namespace keeler::live_view
