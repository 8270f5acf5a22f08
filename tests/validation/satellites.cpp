// What a satellite does to a ringlet that it passes again and again.
#include "rows.hpp"

#include "unit/files/disk.hpp"

#include <keeler/io/snapshot.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler::validation {
namespace {

constexpr int passages = 6;

// From the tenth to the ninetieth percentile of the guiding centres.
double width(const Patch& patch) {
  std::vector<double> guiding;
  for (const Body& body : particles_from(patch, 0.0).bodies)
    guiding.push_back(body.elements.guiding_x);
  std::sort(guiding.begin(), guiding.end());
  return guiding[guiding.size() * 9 / 10] - guiding[guiding.size() / 10];
}

struct Narrowed {
  double part = 1.0; ///< the width after all passages over that at the start
  std::string command;
};

// Each passage is a run of its own, from the end of the one before.
Narrowed passed(const std::vector<std::string>& overrides) {
  const test::TemporaryFolder work;
  const std::string state = (work / "state.hdf").string();
  const char* example = "papers/lewis-stewart-2011";
  Ran ran = run_example(example, overrides);
  Narrowed narrowed;
  narrowed.command =
      fmt::format("{}, and {} times more --from DIR/snap_000001.hdf of the run before", ran.command, passages - 1);
  const double start = width(ran.snapshots.front());
  for (int k = 1; k < passages; ++k) {
    io::write_snapshot(state, ran.snapshots.back(), {});
    std::vector<std::string> next = overrides;
    next.push_back(fmt::format("start.from=\"{}\"", state));
    ran = run_example(example, next);
  }
  narrowed.part = width(ran.snapshots.back()) / start;
  return narrowed;
}

Row width_row(const char* how, const Narrowed& narrowed, double expected, double tolerance, const char* tolerance_is,
              const char* source) {
  return {.what = fmt::format("width of a ringlet after {} passages over that before, {}", passages, how),
          .measured = narrowed.part,
          .expected = expected,
          .tolerance = tolerance,
          .tolerance_is = tolerance_is,
          .source = source,
          .command = narrowed.command};
}

std::vector<Row> negative_diffusion() {
  const char* published = "a ring narrows by up to 90 %: Lewis & Stewart 2011, Icarus 213, 201";
  return {width_row("the wake's streamlines cross", passed({}), 0.5, 0.4,
                    "by 10 %, well above the cell's error, to 90 %", published),
          width_row("the same without collisions",
                    passed({"particles.sizes={ law = \"equal\", radius = 1e-3 }", "particles.count=2546",
                            "particles.velocity_dispersion=1000"}),
                    1.0, 0.05, "the cell's own error of second order, 1 % a passage", "an eccentricity moves no orbit"),
          width_row("no bunching", passed({"satellite.downstream_time=0"}), 1.1, 0.1, "that it spreads",
                    "viscosity, where all streamlines swing alike")};
}

} // namespace

std::vector<Subject> satellite_subjects() {
  return {{"negative-diffusion", "Negative diffusion", false, negative_diffusion}};
}

} // namespace keeler::validation
