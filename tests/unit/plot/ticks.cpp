#include <keeler/plot/axes.hpp>
#include <keeler/plot/ticks.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace ticks_test {

using namespace keeler;
using namespace keeler::plot;

namespace {

std::vector<std::string> labels(const AxisRange& range, bool log, double most = 5.0) {
  std::vector<std::string> all;
  for (const Tick& tick : ticks_of(range, log, most))
    if (!tick.label.empty())
      all.push_back(tick.label);
  return all;
}

using Labels = std::vector<std::string>;

} // namespace

TEST_CASE("round numbers are 1, 2 and 5 times powers of ten") {
  CHECK(round_below(4.9) == 2.0);
  CHECK(round_below(5.0) == 5.0);
  CHECK(round_below(0.3) == doctest::Approx(0.2));
  CHECK(round_above(4.9) == 5.0);
  CHECK(round_above(5.1) == 10.0);
  CHECK(round_above(2.0) == 2.0);
  CHECK(round_above(0.011) == doctest::Approx(0.02));
}

TEST_CASE("linear axes have as many ticks as there is room for, with the digits that they need") {
  CHECK(labels({0.0, 1.0}, false) == Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"});
  CHECK(labels({-2.0, 2.1}, false) == Labels{"-2", "-1", "0", "1", "2"});
  CHECK(labels({1000.0001, 1000.0009}, false) == Labels{"1000.0002", "1000.0004", "1000.0006", "1000.0008"});
  CHECK(labels({0.0, 3e-5}, false) == Labels{"0", "1·10^{-5}", "2·10^{-5}", "3·10^{-5}"});
  CHECK(labels({-7.0, 7.0}, false, 0.9) == Labels{"0"});
  for (double span = 0.001; span < 1000.0; span *= 1.1) {
    const std::size_t count = labels({0.3 * span, 1.3 * span}, false, 6.0).size();
    CHECK(count >= 2);
    CHECK(count <= 7);
  }
}

TEST_CASE("logarithmic axes have powers of ten, or 1, 2 and 5 in a short range") {
  CHECK(labels({0.5, 2000.0}, true) == Labels{"1", "10", "100", "1000"});
  CHECK(labels({1e-6, 1e-3}, true) == Labels{"10^{-6}", "10^{-5}", "10^{-4}", "10^{-3}"});
  CHECK(labels({0.9, 25.0}, true) == Labels{"1", "2", "5", "10", "20"});
  CHECK(labels({1e-9, 1e5}, true).size() <= 6);
  CHECK(labels({3.1, 3.4}, true).size() >= 2); // no round power: linear ticks
  CHECK(ticks_of({1.0, 1000.0}, true, 5.0).size() == 28);
}

TEST_CASE("a range gets a margin, and one value a range") {
  CHECK(AxisRange{1.0, 10.0}.with_margin(false).low == 0.0);
  CHECK(AxisRange{9.0, 10.0}.with_margin(false).low == doctest::Approx(8.94));
  CHECK(AxisRange{0.0, 0.0}.with_margin(false).high > 0.0);
  CHECK(AxisRange{3.0, 3.0}.with_margin(true).low < 3.0);
}

TEST_CASE("a frame has the ends of the axes at its corners") {
  const PlotFrame frame({10.0, 20.0, 100.0, 50.0}, {.log = true, .range = {1.0, 100.0}}, {.range = {-1.0, 1.0}}, {});
  CHECK(frame.at(1.0, -1.0).x == doctest::Approx(10.0));
  CHECK(frame.at(1.0, -1.0).y == doctest::Approx(70.0));
  CHECK(frame.at(10.0, 0.0).x == doctest::Approx(60.0));
  CHECK(frame.at(100.0, 1.0).y == doctest::Approx(20.0));
  CHECK(frame.at(0.0, 0.0).x < -100.0);
}

} // namespace ticks_test
