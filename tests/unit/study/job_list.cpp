#include "job_list.hpp"

#include "unit/files/disk.hpp"

#include <doctest/doctest.h>

#include <fstream>

namespace job_list_test {

using namespace keeler;
using namespace keeler::study;
using namespace keeler::test;

TEST_CASE("a list of jobs stops, is continued, and does nothing twice") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "measurements.jsonl";
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
  const auto progress = [&](const Progress& p) { share = p.fraction; };
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

} // namespace job_list_test
