#include "document.hpp"
#include "job_list.hpp"
#include "step_law.hpp"

#include <keeler/io/files.hpp>
#include <keeler/study/drift_bench.hpp>
#include <keeler/study/median.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <unistd.h>

using namespace keeler;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("keeler-study-" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

} // namespace

TEST_CASE("a list of jobs stops, is continued, and does nothing twice") {
  const Folder folder;
  const fs::path file = folder.path / "measurements.jsonl";
  int worked = 0;
  std::atomic<bool> stop = false;
  std::vector<Job> jobs;
  for (int k = 0; k < 5; ++k)
    jobs.push_back({"job " + std::to_string(k), 1.0, [&worked, &stop, k] {
                      ++worked;
                      stop = k == 2;
                      return Json{{"square", k * k}};
                    }});
  double share = 0.0;
  const auto progress = [&](const StudyProgress& p) { share = p.share; };
  {
    JobList list(file);
    CHECK_FALSE(list.run(jobs, progress, stop));
    CHECK(worked == 3);
    CHECK(share == doctest::Approx(0.6));
  }
  std::ofstream(file, std::ios::app) << "{\"job\": \"job 3\", \"res"; // cut short by a crash
  stop = false;
  JobList list(file);
  CHECK(list.results().size() == 3);
  CHECK(list.run(jobs, progress, stop));
  CHECK(worked == 5);
  CHECK(share == 1.0);
  CHECK(list.results().at("job 4").at("square") == 16);
  CHECK(JobList(file).results().size() == 5);
}

TEST_CASE("the law of the step is found again from its own values") {
  const std::vector<double> steps = {1e-4, 3e-4, 1e-3, 3e-3, 1e-2};
  std::vector<double> times;
  for (const double h : steps)
    times.push_back(2e-3 / h + 40.0 * std::pow(h, 0.8));
  const StepLaw law = fit_step_law(steps, times);
  CHECK(law.a == doctest::Approx(2e-3).epsilon(1e-3));
  CHECK(law.b == doctest::Approx(40.0).epsilon(0.03));
  CHECK(law.d == doctest::Approx(0.8).epsilon(0.01));
  CHECK(law.largest_error < 1e-3);
  CHECK(law.best_step == doctest::Approx(std::pow(2e-3 / (40.0 * 0.8), 1.0 / 1.8)).epsilon(0.03));
  for (std::size_t k = 0; k < steps.size(); ++k)
    times[k] = 2e-3 / steps[k];
  CHECK(fit_step_law(steps, times).best_step == 0.0); // the longer, the better
}

TEST_CASE("a document says the same in both forms") {
  const Folder folder;
  Document document("A < B");
  document.heading("Numbers");
  document.paragraph("Run `keeler` with **care** & N > 1.");
  document.table({{"a", "b"}, {"1", "<2>"}});
  write_text(folder.path / "dot.png", "Man"); // "TWFu" in base64
  document.figure(folder.path, "dot", "A dot.");
  CHECK(document.markdown().find("## Numbers") != std::string::npos);
  CHECK(document.markdown().find("| a | b |\n|---|---|\n| 1 | <2> |") != std::string::npos);
  const std::string html = document.html();
  CHECK(html.find("<h1>A &lt; B</h1>") != std::string::npos);
  CHECK(html.find("<code>keeler</code> with <b>care</b> &amp; N &gt; 1.") != std::string::npos);
  CHECK(html.find("<td>&lt;2&gt;</td>") != std::string::npos);
  CHECK(html.find("data:image/png;base64,TWFu\"") != std::string::npos);
}

TEST_CASE("medians") {
  CHECK(median({3.0, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0, 2.0, 3.0}) == 2.5);
}

TEST_CASE("the bench times an equilibrium") {
  DriftBenchSettings settings;
  settings.count = 1000;
  settings.step_orbits = 5e-3;
  settings.repeats = 2;
  const DriftBench few = bench_drift(settings);
  CHECK(few.ns_per_particle_step > 0.0);
  CHECK(few.ns_per_call > 0.0);
  // the equilibrium of τ = 0.5, ε = 0.5: c_x 2.175 rΩ, 9.4 collisions; a snapshot of 1000 particles scatters
  CHECK(few.dispersion_r_omega == doctest::Approx(2.175).epsilon(0.12));
  CHECK(few.collisions_per_particle_orbit == doctest::Approx(9.4).epsilon(0.25));
  settings.all_pairs = true;
  const DriftBench all = bench_drift(settings);
  CHECK(all.calls_per_particle_step > 10.0 * few.calls_per_particle_step);
  CHECK(all.collisions_per_particle_orbit == few.collisions_per_particle_orbit); // the same collisions
}
