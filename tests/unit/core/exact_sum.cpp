// Compares the superaccumulator with non-overlapping expansions of doubles (Shewchuk 1997, Discrete Comput. Geom. 18,
// 305), an independent exact method: the rounding error of an addition is a double.
#include <keeler/core/exact_sum.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace exact_sum_test {

using namespace keeler;

namespace {

// Returns non-overlapping doubles with the sum of the terms, the smallest first.
std::vector<double> expansion(const std::vector<double>& terms) {
  std::vector<double> parts;
  for (double term : terms) {
    std::size_t kept = 0;
    for (double part : parts) {
      if (std::fabs(term) < std::fabs(part))
        std::swap(term, part);
      const double sum = term + part, error = part - (sum - term);
      if (error != 0.0)
        parts[kept++] = error;
      term = sum;
    }
    parts.resize(kept);
    parts.push_back(term);
  }
  return parts;
}

// True if no neighbouring double is closer to the sum of the terms than `value`.
bool is_nearest(const std::vector<double>& terms, double value) {
  const auto difference_from = [&](double to) {
    std::vector<double> all = terms;
    all.push_back(-to);
    return expansion(all).back(); // has the sign of the whole, and its size to a rounding
  };
  const double infinity = std::numeric_limits<double>::infinity();
  const double off = difference_from(value);
  if (off == 0.0)
    return true;
  const double beside = std::nextafter(value, off > 0.0 ? infinity : -infinity);
  std::vector<double> twice; // 2 sum − value − beside: on which side of the middle the sum lies
  for (int turn = 0; turn < 2; ++turn)
    twice.insert(twice.end(), terms.begin(), terms.end());
  twice.push_back(-value);
  twice.push_back(-beside);
  const double side = expansion(twice).back();
  if (side == 0.0) // the middle: the last bit is even
    return (std::bit_cast<std::uint64_t>(value) & 1) == 0;
  return off > 0.0 ? side < 0.0 : side > 0.0;
}

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms)
    sum += term;
  return sum.value();
}

// Draws terms of both signs with exponents in the given range.
std::vector<double> random_terms(std::mt19937_64& random, std::size_t count, int lowest, int highest) {
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(lowest, highest);
  std::vector<double> terms(count);
  for (double& term : terms)
    term = std::ldexp(mantissa(random), exponent(random));
  return terms;
}

} // namespace

TEST_CASE("an exact sum is rounded once, to the nearest double") {
  std::mt19937_64 random(23);
  const int ranges[][2] = {{0, 0}, {-3, 3}, {-40, 40}, {-300, 300}, {-1060, -950}, {-1074, 900}, {990, 1005}};
  for (const auto& range : ranges)
    for (const std::size_t count : {1U, 2U, 3U, 10U, 500U}) {
      for (int trial = 0; trial < 40; ++trial) {
        std::vector<double> terms = random_terms(random, count, range[0], range[1]);
        CHECK(is_nearest(terms, sum_of(terms)));
        // cancellation: all but one are subtracted again, and a little is added
        const std::size_t half = terms.size();
        for (std::size_t k = 1; k < half; ++k)
          terms.push_back(-terms[k]);
        CHECK(sum_of(terms) == terms[0]);
        terms.push_back(std::ldexp(terms[0], -53)); // half of a last bit, and more or less than that
        CHECK(is_nearest(terms, sum_of(terms)));
        terms.push_back(std::ldexp(terms[0], -120));
        CHECK(is_nearest(terms, sum_of(terms)));
      }
    }
}

TEST_CASE("ties round to even, unless much lower bits decide") {
  for (const double sign : {1.0, -1.0})
    for (const int scale : {0, 17, 31, 32, 500, -500}) {
      const auto scaled = [&](double number) { return sign * std::ldexp(number, scale); };
      const double bit = 0x1p-52;
      CHECK(sum_of({scaled(1.0), scaled(0.5 * bit)}) == scaled(1.0));
      CHECK(sum_of({scaled(1.0 + bit), scaled(0.5 * bit)}) == scaled(1.0 + 2.0 * bit));
      CHECK(sum_of({scaled(1.0), scaled(0.5 * bit), sign * 0x1p-900}) == scaled(1.0 + bit));
      CHECK(sum_of({scaled(1.0 + bit), scaled(0.5 * bit), -sign * 0x1p-900}) == scaled(1.0 + bit));
    }
}

TEST_CASE("exact sums do not depend on order, grouping or threads") {
  std::mt19937_64 random(7);
  std::vector<double> terms = random_terms(random, 20011, -60, 60);
  const double whole = sum_of(terms);
  CHECK(is_nearest(terms, whole));
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(terms.begin(), terms.end(), random);
    CHECK(sum_of(terms) == whole);
    std::vector<ExactSum> parts(7); // each with carries that wait
    for (const double term : terms)
      parts[random() % parts.size()] += term;
    ExactSum all;
    for (const ExactSum& part : parts)
      all += part;
    CHECK(all.value() == whole);
    set_threads(1 + trial % 4);
    CHECK(exact_sum(terms.size(), [&](std::size_t k) { return terms[k]; }) == whole);
  }
  set_threads(1);
}

TEST_CASE("exact sums inside a parallel region of the caller") {
  double sums[4] = {};
#pragma omp parallel num_threads(4)
  {
    set_threads(1);
    for (const std::size_t count : {std::size_t{10}, std::size_t{5000}})
      sums[omp_get_thread_num()] += exact_sum(count, [](std::size_t k) { return static_cast<double>(k); });
  }
  for (const double sum : sums)
    CHECK(sum == 45.0 + 12497500.0);
  set_threads(1);
}

TEST_CASE("more terms of one sign than fit before a carry, added and merged") {
  const double term = 1.0 - 0x1p-53; // all bits set
  ExactSum sum, merged;
  for (int k = 0; k < 100000; ++k) {
    sum += term;
    ExactSum one;
    one += term;
    merged += one;
  }
  CHECK(sum.value() == 100000.0 - 100000.0 * 0x1p-53);
  CHECK(merged.value() == sum.value());
}

TEST_CASE("exact sums at the ends of the range of doubles") {
  constexpr double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(sum_of({}) == 0.0);
  CHECK(sum_of({0.0, -0.0}) == 0.0);
  CHECK(sum_of({least}) == least);
  CHECK(sum_of({-least, -least, -least}) == -3.0 * least);
  CHECK(sum_of({0x1p-1022, -least}) == 0x1p-1022 - least);
  CHECK(sum_of({most, most, -most}) == most); // beyond the range between
  CHECK(sum_of({most, most}) == infinity);
  CHECK(sum_of({-most, -most, least}) == -infinity);
  CHECK(sum_of({1.0, infinity}) == infinity);
  CHECK(std::isnan(sum_of({infinity, 1.0, -infinity})));
  CHECK(std::isnan(sum_of({1.0, NAN})));
}

TEST_CASE("exact sums of vectors") {
  ExactVec3 sum, more;
  for (const Vec3& term : {Vec3(1.0, 1e17, 3.0), Vec3(1e-30, 1.0, -3.0)})
    sum += term;
  more += Vec3(-1.0, -1e17, 0.25);
  sum += more;
  CHECK(sum.value() == Vec3(1e-30, 1.0, 0.25));
}

TEST_CASE("words of exact sums can be added, for any number of parts") {
  std::mt19937_64 random(11);
  const std::vector<double> terms = random_terms(random, 3000, -60, 60);
  std::vector<std::uint64_t> words(ExactSum().words().size());
  ExactSum whole;
  for (std::size_t part = 0; part < 7; ++part) {
    ExactSum sum;
    for (std::size_t k = part; k < terms.size(); k += 7)
      sum += terms[k];
    const std::vector<std::uint64_t> its = sum.words();
    for (std::size_t w = 0; w < words.size(); ++w)
      words[w] += its[w];
  }
  for (const double term : terms)
    whole += term;
  CHECK(ExactSum::of_words(words).value() == whole.value());
  words.back() = 1; // one of them was not finite
  CHECK(std::isnan(ExactSum::of_words(words).value()));
}

} // namespace exact_sum_test
