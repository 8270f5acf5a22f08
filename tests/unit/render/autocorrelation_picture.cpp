#include <keeler/render/autocorrelation_picture.hpp>

#include "picture.hpp"
#include "unit/diagnostics/states.hpp"

#include <keeler/core/error.hpp>

namespace autocorrelation_picture_test {

using namespace keeler;

namespace {
const ShearingBox box{245.0, 200.0, 1.5, 0.0};
}

TEST_CASE("the autocorrelation picture is warm along the ridge and cold beside it") {
  const test::Wave wave(box, 63.7, 4, 1);
  const Patch patch = test::scattered(box, 63.7, 6000, 1, wave);
  const AutocorrelationMap map = mean_autocorrelation({&patch, 1});
  const Wakes wakes = find_wakes(map, 61.4);
  REQUIRE(wakes.spacing);
  const test::TemporaryPng file("autocorrelation");
  render_autocorrelation(map, wakes, 61.4, file.path(), "A density wave");
  const test::Picture picture(file.path());
  CHECK(picture.width() == 1600);
  CHECK(picture.height() == 860);
  // The map is the square of 620 pixels at (120, 130); 12 pixels beside the dashed line is still the ridge.
  double ridge = 0.0, lane = 0.0;
  const double pixels_per_metre = 310.0 / 100.0, pitch = wave.pitch;
  for (int s = -60; s <= 60; s += 5) {
    const auto at = [&](double dx) {
      return picture.warmth(430 + static_cast<int>(pixels_per_metre * (dx + s * std::sin(pitch))),
                            440 + static_cast<int>(pixels_per_metre * s * std::cos(pitch)));
    };
    ridge += at(4.0);
    lane += at(0.5 * wave.radial_length);
  }
  CHECK(ridge > 500.0); // 25 pixels each
  CHECK(lane < -500.0);
}

TEST_CASE("a map without wakes, or without a resolved wavelength, is drawn too") {
  const Patch patch = test::uniform(box, 10.0, 3000, 1);
  const AutocorrelationMap map = mean_autocorrelation({&patch, 1});
  for (const double wavelength : {61.4, 3.0}) {
    const test::TemporaryPng file("plain");
    render_autocorrelation(map, find_wakes(map, wavelength), wavelength, file.path(), "Nothing");
    CHECK(test::Picture(file.path()).width() == 1600);
  }
  CHECK_THROWS_AS(render_autocorrelation(map, {}, 61.4, "/nowhere/at/all.png", "No room"), IoError);
}

} // namespace autocorrelation_picture_test
