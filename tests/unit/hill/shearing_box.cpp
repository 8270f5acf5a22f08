#include <keeler/hill/shearing_box.hpp>

#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace shearing_box_test {

using namespace keeler;

TEST_CASE("the shear offset is exact after any number of steps") {
  const ShearingBox box{245.0, 197.0, 1.5054, 3.25};
  const double half = pi * 1e-3;
  for (const std::int64_t count : {0LL, 1LL, 17LL, 1'000'003LL, 200'000'001LL}) {
    // x87 extended precision holds this product to 2^-64
    const long double travelled = static_cast<long double>(box.shear * box.size_x * half) * count + 3.25L;
    const long double expected = std::fmod(travelled, 197.0L);
    CHECK(std::fabs(box.offset(count, half) - static_cast<double>(expected)) < 1e-10);
    CHECK(box.offset(count, half) >= 0.0);
    CHECK(box.offset(count, half) < box.size_y);
  }
}

TEST_CASE("an image moves as a particle of its own: it drifts with the shear of its place") {
  const Frequencies f{0.99458, 1.00539};
  const ShearingBox box{245.0, 197.0, f.shear(), 0.0};
  const double half = pi * 1e-3;
  const Elements el{17.0, -60.0, 1.0, 0.3, 0.2, 0.1};
  for (const Image image : {Image{1, 0}, Image{-2, 3}}) {
    // at the epoch (half step 7) and two half steps later, without folding the offset
    const Elements there = box.image_of(el, image, box.offset(7, half));
    const Vec3 later = state_at(there, f, Rotation(f, 2 * half)).position;
    const Vec3 own = state_at(el, f, Rotation(f, 2 * half)).position;
    const Vec3 expected = own + box.displacement(image, box.offset(9, half));
    CHECK((later - expected).norm() < 1e-11);
  }
}

TEST_CASE("coordinates that are too far away or not finite get an image without undefined behaviour") {
  const ShearingBox box{64.0, 32.0, 1.5, 0.0};
  CHECK(box.image_into_cell(64.0e6, 32.0e6, 0.0) == Image{-1000000, -1000000});
  for (const double far : {1e12, 1e300, HUGE_VAL, -1e12, -1e300, -HUGE_VAL}) {
    const Image image = box.image_into_cell(far, far, 7.0);
    CHECK(-image == Image{-image.nx, -image.ny});
    CHECK(std::signbit(far) == (image.nx > 0));
  }
  CHECK_FALSE(box.image_into_cell(NAN, NAN, 7.0) == Image{});
}

TEST_CASE("a free particle wraps 10^6 times without loss") {
  // Wraps in y come from the shear, wraps in x are forced by shifting X: e, i must keep every bit, X and Y to rounding.
  const Frequencies f{1.0, 1.0};
  const ShearingBox box{64.0, 32.0, f.shear(), 0.0};
  const Elements first{20.0, 1.0, 0.7, -0.2, 0.5, 0.1};
  Elements el = first;
  std::int64_t half_steps = 1;
  const double half = 0.25;
  long net_x = 0, wraps = 0;
  for (long k = 0; k < 1'000'000; ++k) {
    const int push = k % 2 == 0 ? 1 : -1;
    el.guiding_x += push * 64.0;
    const Image image = box.image_into_cell(el.guiding_x, el.guiding_y, box.offset(half_steps, half));
    el = box.image_of(el, image, box.offset(half_steps, half));
    net_x += image.nx + push;
    wraps += image.nx != 0;
    CHECK((el.guiding_x >= -32.0 && el.guiding_x < 32.0 && el.guiding_y >= -16.0 && el.guiding_y < 16.0));
  }
  CHECK(wraps == 1'000'000);
  CHECK(net_x == 0);
  CHECK(el.guiding_x == first.guiding_x);
  CHECK(std::fabs(std::remainder(el.guiding_y - first.guiding_y, 32.0)) < 1e-9);
  CHECK(el.e_cos == first.e_cos);
  CHECK(el.e_sin == first.e_sin);
  CHECK(el.i_sin == first.i_sin);
  CHECK(el.i_cos == first.i_cos);
}

} // namespace shearing_box_test
