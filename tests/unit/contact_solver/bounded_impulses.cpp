// Impulses that only push: statics with known forces, and random networks against a search through all free sets.
#include <bounded_impulses.hpp>

#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <optional>

namespace bounded_impulses_test {

using namespace keeler;
using namespace keeler::contact_solver;

namespace {

struct Network {
  std::vector<Joint> joints;
  std::vector<double> inverse_masses, required;

  std::vector<double> solve(double tolerance) const {
    std::vector<double> impulses(joints.size());
    BoundedImpulses solver(joints, inverse_masses);
    REQUIRE(solver.solve(required, std::vector<double>(joints.size(), tolerance), impulses));
    return impulses;
  }

  std::vector<Vec3> changes(const std::vector<double>& impulses) const {
    std::vector<Vec3> out(inverse_masses.size());
    BoundedImpulses(joints, inverse_masses).apply(impulses, out);
    return out;
  }

  Eigen::MatrixXd matrix() const {
    const auto count = static_cast<Eigen::Index>(joints.size());
    Eigen::MatrixXd a(count, count);
    for (std::size_t c = 0; c < joints.size(); ++c) {
      std::vector<double> unit(joints.size());
      unit[c] = 1.0;
      const std::vector<Vec3> response = changes(unit);
      for (std::size_t d = 0; d < joints.size(); ++d)
        a(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(c)) =
            joints[d].normal.dot(response[joints[d].high] - response[joints[d].low]);
    }
    return a;
  }

  // Brute force: tries each free set of joints, with the impulses that meet their requirements, until all others open.
  std::optional<std::vector<double>> by_all_sets(double tolerance) const {
    const Eigen::MatrixXd a = matrix();
    const Eigen::Map<const Eigen::VectorXd> r(required.data(), a.rows());
    for (unsigned set = 0; set < 1u << joints.size(); ++set) {
      std::vector<Eigen::Index> members;
      for (Eigen::Index c = 0; c < a.rows(); ++c)
        if (set >> c & 1u)
          members.push_back(c);
      Eigen::VectorXd x = Eigen::VectorXd::Zero(a.rows());
      if (!members.empty()) {
        const Eigen::MatrixXd among = a(members, members);
        const Eigen::VectorXd target = r(members), pushes = least_squares(among, target).solution;
        for (std::size_t m = 0; m < members.size(); ++m)
          x(members[m]) = pushes(static_cast<Eigen::Index>(m));
      }
      const Eigen::VectorXd open = a * x - r;
      const bool held = members.empty() || open(members).cwiseAbs().maxCoeff() < tolerance;
      if (x.minCoeff() >= 0.0 && open.minCoeff() > -tolerance && held)
        return std::vector<double>(x.data(), x.data() + x.size());
    }
    return std::nullopt;
  }
};

Vec3 direction(RandomStream& random) {
  for (;;) {
    const Vec3 v(2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0);
    if (v.norm() > 0.1 && v.norm() < 1.0)
      return v.normalized();
  }
}

} // namespace

// Each body is pulled by one unit towards the middle of a chain: a joint supports all bodies beyond it.
TEST_CASE("each joint of a chain supports the sum of the pulls beyond it") {
  Network chain;
  constexpr int count = 9;
  chain.inverse_masses.assign(count, 1.0);
  const auto pull = [](int k) { return k < count / 2 ? 1.0 : k > count / 2 ? -1.0 : 0.0; };
  for (int k = 0; k + 1 < count; ++k) {
    chain.joints.push_back({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k + 1), Vec3(0.6, 0.0, 0.8)});
    chain.required.push_back(pull(k) - pull(k + 1));
  }
  const std::vector<double> impulses = chain.solve(1e-12);
  for (int k = 0; k + 1 < count; ++k)
    CHECK(impulses[static_cast<std::size_t>(k)] == doctest::Approx(std::min(k + 1, count - 1 - k)).epsilon(1e-10));
}

// A ball of mass m and weight W on two that cannot move, with centres in an equilateral triangle: each supports
// W / (2 cos 30°).
TEST_CASE("a ball on two others presses on each as in statics") {
  Network triangle;
  const Vec3 left(0.5, 0.0, std::sqrt(0.75)), right(-0.5, 0.0, std::sqrt(0.75));
  triangle.joints = {{0, 2, left}, {1, 2, right}, {0, 1, Vec3::UnitX()}};
  triangle.inverse_masses = {0.0, 0.0, 0.25};
  constexpr double fall = 3.0; // m rad⁻¹, by the kick
  triangle.required = {fall * left.z(), fall * right.z(), 0.0};
  triangle.joints.pop_back(); // the two are fixed
  triangle.required.pop_back();
  const std::vector<double> impulses = triangle.solve(1e-12);
  for (const double impulse : impulses)
    CHECK(impulse == doctest::Approx(4.0 * fall / (2.0 * std::cos(std::acos(-1.0) / 6.0))).epsilon(1e-10));
}

TEST_CASE("random networks: the motion equals that by trial of all free sets, and momentum is conserved") {
  RandomStream random(7, RandomPurpose::sample, 0);
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Network network;
    const std::size_t bodies = 3 + static_cast<std::size_t>(4 * random.uniform()), joints = bodies + trial % 3;
    for (std::size_t b = 0; b < bodies; ++b)
      network.inverse_masses.push_back(std::pow(10.0, -3.0 * random.uniform()));
    for (std::size_t c = 0; c < joints; ++c) {
      const auto low = static_cast<std::uint32_t>(static_cast<double>(bodies) * random.uniform());
      const auto step = 1 + static_cast<std::uint32_t>(static_cast<double>(bodies - 1) * random.uniform());
      network.joints.push_back({low, static_cast<std::uint32_t>((low + step) % bodies), direction(random)});
      network.required.push_back(2.0 * random.uniform() - 1.0);
    }
    const auto plain = network.by_all_sets(1e-9);
    if (!plain)
      continue; // no impulses open all of them
    ++compared;
    const std::vector<double> impulses = network.solve(1e-11);
    const std::vector<Vec3> expected = network.changes(*plain), found = network.changes(impulses);
    Vec3 momentum = Vec3::Zero();
    double size = 0.0;
    for (std::size_t b = 0; b < bodies; ++b) {
      CHECK((found[b] - expected[b]).norm() < 1e-7 * (1.0 + expected[b].norm()));
      momentum += found[b] / network.inverse_masses[b];
      size += found[b].norm() / network.inverse_masses[b];
    }
    CHECK(momentum.norm() <= 1e-14 * size);
    for (const double impulse : impulses)
      CHECK(impulse >= 0.0);
  }
  CHECK(compared > 200);
}

TEST_CASE("two opposite joints that no impulses can open are reported as jammed") {
  Network jammed;
  jammed.joints = {{0, 1, Vec3::UnitX()}, {0, 1, -Vec3::UnitX()}};
  jammed.inverse_masses = {1.0, 1.0};
  jammed.required = {1.0, 1.0};
  std::vector<double> impulses(2);
  BoundedImpulses solver(jammed.joints, jammed.inverse_masses);
  CHECK_FALSE(solver.solve(jammed.required, std::vector<double>(2, 1e-9), impulses));
}

} // namespace bounded_impulses_test
