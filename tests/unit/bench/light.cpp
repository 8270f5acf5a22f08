#include <keeler/bench/light.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/light/photometry.hpp>

#include <doctest/doctest.h>

namespace bench_light_test {

using namespace keeler;
using namespace keeler::bench;

TEST_CASE("the ray tracer is timed in a patch: paths take longer than rays, and 1 % of I/F its rays") {
  LightBenchSettings settings;
  settings.count = 2400;
  settings.state = "uniform";
  settings.repeats = 1;
  if (!light::can_trace()) {
    CHECK_THROWS_AS(bench_light(settings), Error);
    return;
  }
  set_threads(1);
  const LightBench found = bench_light(settings);
  CHECK(found.count >= 2400);
  CHECK(found.paths_per_s > 1000.0);
  CHECK(found.first_hits_per_s > found.paths_per_s);
  CHECK(found.any_hits_per_s > found.paths_per_s);
  CHECK(found.embree_rays_per_s > 0.0);
  CHECK(found.embree_packet_rays_per_s > 0.0);
  CHECK(found.spheres_met > 0.2); // optical depth 0.5, 20 degrees above the plane
  CHECK(found.spheres_met < 3.0);
  CHECK(found.one_percent_rays % light::round_rays == 0);
  CHECK(found.one_percent_s > 0.0);
}

} // namespace bench_light_test
