// keeler bench gravity: error and cost of every solver and setting.
#include "bench.hpp"
#include "print.hpp"

#include <keeler/bench/gravity.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/json_of_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace keeler::cli {
namespace {

struct GravityOptions {
  bench::GravityBenchSettings bench;
  bool json = false;
  BenchThreadOption threads;
};

void print_json(const GravityOptions& options, const bench::GravityBench& b) {
  nlohmann::ordered_json json;
  json["rows"] = nlohmann::ordered_json::array();
  for (const bench::GravityBenchRow& row : b.rows) {
    nlohmann::ordered_json line = {{"solver", row.choice.solver}, {"settings", row.choice.text}};
    for (const auto& [name, value] : row.numbers())
      line[name] = value;
    line["threads"] = threads();
    json["rows"].push_back(line);
  }
  json["state"] = options.bench.state;
  json["preparation_s"] = b.preparation_s;
  json["count"] = b.count;
  json["box_m"] = {b.size_x_m, b.size_y_m};
  json["offset_m"] = b.offset_m;
  json["sample"] = b.sample;
  json["edge_sample"] = b.edge_sample;
  json["edge_width_m"] = b.edge_width_m;
  json["threads"] = threads();
  json["repeats"] = options.bench.repeats;
  print("{}\n", json_text(json, 2));
}

void print_text(const GravityOptions& options, const bench::GravityBench& b) {
  print("{}, {}, box {} m x {} m, shear offset {} m, {}\n", pluralize(b.count, "particle"), options.bench.state,
        format_number(b.size_x_m, 4), format_number(b.size_y_m, 4), format_number(b.offset_m, 4),
        pluralize(threads(), "thread"));
  print("errors relative to the rms force, of {} particles and of {} within {:g} m of the edges; medians of {}\n\n",
        b.sample, b.edge_sample, b.edge_width_m, pluralize(options.bench.repeats, "repeat"));
  print("{:<8}{:<22}{:>12}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}{:>10}\n", "solver", "settings", "ns/particle", "rms",
        "99.9 %", "x", "y", "z", "edge", "edge pull", "net force");
  for (const bench::GravityBenchRow& row : b.rows) {
    const diagnostics::ForceErrors& e = row.errors;
    print("{:<8}{:<22}{:>12.0f}{:>9.1e}{:>9.1e}{:>9.1e}{:>9.1e}{:>9.1e}{:>9.1e}{:>10.1e}{:>10.1e}\n", row.choice.solver,
          row.choice.text, row.ns_per_particle, e.rms, e.p999, e.component_rms[0], e.component_rms[1],
          e.component_rms[2], e.edge_rms, e.edge_pull, row.net_force);
  }
}

ExitCode bench(GravityOptions& options) {
  options.threads.apply();
  const bench::GravityBench result = measured(options.bench, bench::bench_gravity);
  if (options.json)
    print_json(options, result);
  else
    print_text(options, result);
  return ExitCode::done;
}

} // namespace

void add_bench_gravity(CLI::App& bench_command, Action& action) {
  const auto options = std::make_shared<GravityOptions>();
  CLI::App& gravity = *bench_command.add_subcommand(
      "gravity", "the gravity solvers: cost and error of each setting, in a patch of Saturn's A ring");
  one_of(gravity.add_option("--solver", options->bench.solver,
                            "one solver (default: all, direct only up to 10000 particles, so not of settled)"),
         bench::gravity_solver_names());
  gravity.add_option("--count", options->bench.count, "particles, at least 25336 of settled (default: 100000)")
      ->transform(particle_number());
  add_state(gravity, options->bench.state);
  add_repeats(gravity, options->bench.repeats);
  options->threads.add_to(gravity);
  gravity.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(gravity, {"keeler bench gravity --state uniform --count 10000"});
  gravity.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler::cli
