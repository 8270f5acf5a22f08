// The kernel that makes the lines of a pruning interval from orbits, in every instruction set: lines against the true
// paths, and the particles that leave their reference path.
#include "neighbours/kernels.hpp"

#include "draws.hpp"
#include "unit/collision/spheres.hpp"

#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace kernels_follow_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

constexpr double full_turn = 4294967296.0; // 2³², the box
constexpr std::size_t number = 61;         // lines, no multiple of any vector's length
constexpr InstructionSet all_sets[] = {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};

std::int32_t wrapped(double fraction) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(std::llround(fraction)));
}

// Bodies with reference paths that they leave by up to twice the skin; some are far from theirs. Some bodies are
// several boxes outside the cell.
struct Followed {
  test::RandomVectors random;
  Frequencies f;
  ShearingBox box;
  double offset, after, since, half, heat; // m; rad; m
  FollowFrame frame;
  std::vector<Body> bodies;
  std::vector<Line> references;
  std::vector<double> curvature; // of each path in the span, m

  explicit Followed(std::uint64_t seed) : random(seed) {
    f.kappa = 0.7 + 0.3 * random.uniform();
    f.nu = 1.0 + 2.0 * random.uniform();
    half = decades(-4.0, -0.7);
    after = random.uniform() - 0.5;
    since = 4.0 * half * (random.uniform() - 0.5);
    heat = decades(-3.0, 2.0);
    const double least = 20.0 * (2.0 + heat);
    box = {least * decades(0.0, 4.0), least * decades(0.0, 4.0), f.shear(), 0.0};
    offset = box.size_y * (random.uniform() - 0.5);
    frame = {f.kappa,
             f.nu,
             f.shear(),
             after,
             middle().cos_e,
             middle().sin_e,
             middle().cos_i,
             middle().sin_i,
             box.size_x,
             full_turn / box.size_x,
             full_turn / box.size_y,
             offset_at(0.0) * (full_turn / box.size_y),
             since,
             half,
             4.0 / full_turn * (box.size_x + box.size_y)};
    for (std::size_t k = 0; k < number; ++k)
      add(k);
    references.resize(number + kernel_padding);
  }

  double decades(double least, double most) { return std::pow(10.0, least + (most - least) * random.uniform()); }
  double centred(double width) { return width * (random.uniform() - 0.5); }
  Rotation middle() const { return Rotation(f, after); }
  // Returns the shear offset `time` (rad) after the middle, not reduced to the box.
  double offset_at(double time) const { return offset + box.shear * box.size_x * (after + time); }

  void add(std::size_t k) {
    Body body;
    body.radius = decades(-1.0, 0.0);
    body.elements = {centred(1.01 * box.size_x),
                     centred(1.01 * box.size_y),
                     centred(heat),
                     centred(heat),
                     centred(heat),
                     centred(heat)};
    if (k % 5 == 0) { // boxes away
      body.elements.guiding_x += box.size_x * std::rint(centred(6.0));
      body.elements.guiding_y += box.size_y * std::rint(centred(6.0));
    }
    const Elements& el = body.elements;
    curvature.push_back(0.5 * half * half *
                        (2.0 * f.kappa * (std::fabs(el.e_cos) + std::fabs(el.e_sin)) +
                         f.nu * f.nu * (std::fabs(el.i_sin) + std::fabs(el.i_cos))) *
                        1.5); // at the epoch; it may change until the middle
    bodies.push_back(body);
    references.push_back(reference(body, decades(-1.5, 0.5) + 2.0 * curvature.back(), k % 11 == 0));
  }

  Line reference(const Body& body, double skin, bool far) {
    const State s = state_at(body.elements, f, middle());
    const double off = 2.0 * skin * random.uniform() * random.uniform(), part = random.uniform();
    Vec3 position = s.position + part * off * random.direction();
    Vec3 velocity = s.velocity + (1.0 - part) * off / half * random.direction();
    if (far)
      position += Vec3(centred(box.size_x), centred(box.size_y), 0.0);
    position -= since * velocity;
    const double boxes = std::floor(position.x() / box.size_x + 0.5); // the image into the cell
    return {wrapped((position.x() / box.size_x - boxes) * full_turn),
            wrapped((position.y() + boxes * offset_at(-since)) / box.size_y * full_turn),
            static_cast<float>(position.z()),
            static_cast<float>(velocity.x()),
            static_cast<float>(velocity.y() + box.shear * position.x()),
            static_cast<float>(velocity.z()),
            static_cast<float>(body.radius + skin),
            0};
  }

  // Returns the largest distance of the true path from a line of this age in the span.
  double farthest(const Body& body, const Line& line, double age) const {
    constexpr int times = 16;
    double most = 0.0;
    for (int k = -times; k <= times; ++k)
      most = std::max(most, distance(body, line, age, half * k / times));
    return most;
  }

  // Returns that distance `time` (rad) after the middle, when the line is older by `age`.
  double distance(const Body& body, const Line& line, double age, double time) const {
    const Vec3 path = state_at(body.elements, f, Rotation(f, after + time)).position;
    const double x = line.x / full_turn * box.size_x, y = line.y / full_turn * box.size_y, t = age + time;
    Vec3 d = path - Vec3(x + t * line.u, y + t * (line.v - box.shear * x), line.z + t * static_cast<double>(line.w));
    const double boxes = std::rint(d.x() / box.size_x);
    d.x() -= boxes * box.size_x;
    d.y() += boxes * offset_at(time);
    d.y() -= box.size_y * std::rint(d.y() / box.size_y);
    return d.norm();
  }

  struct Lines {
    std::vector<Line> lines;
    std::vector<std::uint32_t> escaped;
  };
  Lines follow(InstructionSet set, std::size_t begin, std::size_t end, float untouched = 0.0f) const {
    Lines all{std::vector<Line>(number + kernel_padding, Line{0, 0, untouched, 0.0f, 0.0f, 0.0f, 0.0f, 0}),
              std::vector<std::uint32_t>(end - begin)};
    all.escaped.resize(kernels(set).follow(&bodies[0].elements.guiding_x, references.data(), frame, begin, end,
                                           all.lines.data(), all.escaped.data()));
    return all;
  }
};

bool same(const Line& a, const Line& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.u == b.u && a.v == b.v && a.w == b.w && a.size == b.size;
}

} // namespace

TEST_CASE(
    "a line contains its true path, and particles that leave their reference path by more than the skin are listed") {
  std::size_t leave = 0, listed = 0, stay = 0, outside = 0;
  for (std::uint64_t seed = 1; seed <= test::draws(1500); ++seed) {
    const Followed followed(seed);
    const Followed::Lines found = followed.follow(InstructionSet::portable, 0, number);
    CAPTURE(seed);
    for (std::uint32_t k = 0; k < number; ++k) {
      CAPTURE(k);
      const Body& body = followed.bodies[k];
      const Line &line = found.lines[k], &reference = followed.references[k];
      const double room = static_cast<double>(line.size) - body.radius;
      const double error = followed.farthest(body, line, 0.0);
      if (!(error <= room))
        CHECK(error <= room);
      if (!(room < 1.1 * (followed.curvature[k] + 1e-4 * (line.size + followed.heat)) + 2.0 * followed.frame.allowance))
        CHECK(room <
              1.1 * (followed.curvature[k] + 1e-4 * (line.size + followed.heat)) + 2.0 * followed.frame.allowance);
      const double off = followed.farthest(body, reference, followed.since), skin = reference.size - body.radius;
      const bool leaves = std::binary_search(found.escaped.begin(), found.escaped.end(), k);
      const bool well_inside = off + 2.0 * room < 0.9 * skin;
      if (off > skin && !leaves)
        CHECK(off <= skin);
      if (well_inside && leaves)
        CHECK(off + 2.0 * room >= 0.9 * skin);
      leave += off > skin;
      listed += leaves;
      stay += well_inside;
      outside += std::fabs(body.elements.guiding_x) > 0.5 * followed.box.size_x;
    }
  }
  MESSAGE(leave << " leave, " << listed << " listed, " << stay << " well inside, " << outside << " from outside");
  CHECK(leave > test::draws(10000));
  CHECK(stay > test::draws(30000));
  CHECK(outside > test::draws(5000));
}

TEST_CASE("all instruction sets make the same lines and find the same escaped particles, from any multiple of 8 on") {
  for (std::uint64_t seed = 1; seed <= test::draws(600); ++seed) {
    Followed followed(seed);
    const std::size_t begin = 8 * static_cast<std::size_t>(followed.random.uniform() * 8.0);
    const std::size_t end = begin + static_cast<std::size_t>(followed.random.uniform() * double(number + 1 - begin));
    const Followed::Lines all = followed.follow(InstructionSet::portable, 0, number);
    std::vector<std::uint32_t> escaped;
    std::copy_if(all.escaped.begin(), all.escaped.end(), std::back_inserter(escaped),
                 [&](std::uint32_t k) { return k >= begin && k < end; });
    for (const InstructionSet set : all_sets)
      if (supports(set)) {
        CAPTURE(seed);
        CAPTURE(instruction_set_name(set));
        const Followed::Lines some = followed.follow(set, begin, end, 77.0f);
        CHECK((some.escaped == escaped));
        const auto wrong = [&](std::size_t k) {
          const bool inside = k >= begin && k < end;
          return inside ? !same(some.lines[k], all.lines[k]) : k < begin && some.lines[k].z != 77.0f;
        };
        for (std::size_t k = 0; k < number; ++k)
          if (wrong(k))
            CHECK_FALSE(wrong(k));
      }
  }
}

TEST_CASE("a particle that is not finite escapes, and none beside it") {
  constexpr double huge = std::numeric_limits<double>::infinity();
  Followed followed(3);
  for (std::size_t k = 0; k < number; ++k) // all stay
    followed.references[k] = followed.reference(followed.bodies[k], 0.0, false);
  for (std::size_t k = 0; k < number; ++k)
    followed.references[k].size += 1e6f;
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), huge, -huge})
    for (std::uint32_t k = 0; k < number; k += 7)
      for (std::size_t field = 0; field < 7; ++field) { // the elements and the radius
        Body& body = followed.bodies[k];
        const Body before = body;
        (&body.elements.guiding_x)[field] = value;
        for (const InstructionSet set : all_sets)
          if (supports(set) && !(field == 6 && value == -huge)) { // no radius
            CAPTURE(k);
            CAPTURE(field);
            CAPTURE(value);
            CAPTURE(instruction_set_name(set));
            CHECK((followed.follow(set, 0, number).escaped == std::vector<std::uint32_t>{k}));
          }
        body = before;
      }
}

} // namespace kernels_follow_test
