#include <keeler/core/exact_sum.hpp>

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

constexpr int max_added = 1024; // each below 2⁵², added to the 32 bits that propagate_carries() leaves

} // namespace

// Leaves 32 bits in each word, and the sign in the topmost, so that the representation of each sum is unique.
void ExactSum::propagate_carries() {
  for (std::size_t w = 0; w + 1 < words_.size(); ++w) {
    const std::int64_t over = words_[w] >> 32;
    words_[w] -= over * (std::int64_t{1} << 32);
    words_[w + 1] += over;
  }
  added_ = 0;
}

void ExactSum::add_to_words(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const auto exponent = static_cast<std::uint32_t>(bits >> 52) & 0x7FF;
  if (exponent == 0x7FF) {
    not_finite_ += term;
    return;
  }
  // a subnormal has the scale of the smallest exponent, and no hidden bit
  const std::uint32_t scale = exponent == 0 ? 1 : exponent;
  const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{exponent != 0} << 52;
  const std::uint32_t word = scale / 32, shift = scale % 32;
  const std::int64_t sign = bits >> 63 != 0 ? -1 : 1;
  words_[word] += sign * static_cast<std::int64_t>((mantissa << shift) & 0xFFFFFFFF);
  words_[word + 1] += sign * static_cast<std::int64_t>(mantissa >> (32 - shift));
  if (++added_ == max_added)
    propagate_carries();
}

// Splits each term at two units. Sums of the upper and of the middle parts have less than 53 bits above their unit, so
// plain additions are exact, in any order. The few remainders below both units are added to the words one by one.
// Precondition: sum_of_sizes = Σ |term| is neither near underflow nor near overflow.
void ExactSum::add_in_parts(double sum_of_sizes) {
  const double upper_unit = std::ldexp(1.0, std::ilogb(sum_of_sizes) - 49), lower_unit = 0x1p-46 * upper_unit;
  static_assert(max_terms <= 128); // 2⁷ times half an upper unit are 2⁵² lower ones
  // adding one of these to a number rounds off the bits below the unit
  const double upper_cut = 0x1.8p52 * upper_unit, lower_cut = 0x1.8p52 * lower_unit;
  double upper = 0.0, middle = 0.0, left = 0.0;
#pragma omp simd reduction(+ : upper, middle, left)
  for (std::size_t k = 0; k < buffered_; ++k) {
    const double high = (terms_[k] + upper_cut) - upper_cut, below = terms_[k] - high;
    const double mid = (below + lower_cut) - lower_cut;
    upper += high;
    middle += mid;
    terms_[k] = below - mid;
    left += std::fabs(terms_[k]);
  }
  add_to_words(upper);
  add_to_words(middle);
  if (left > 0.0)
    for (std::size_t k = 0; k < buffered_; ++k)
      add_to_words(terms_[k]);
}

void ExactSum::flush_terms() {
  double sizes = 0.0;
#pragma omp simd reduction(+ : sizes)
  for (std::size_t k = 0; k < buffered_; ++k)
    sizes += std::fabs(terms_[k]);
  if (sizes > 0x1p-800 && sizes < 0x1p800)
    add_in_parts(sizes);
  else if (sizes != 0.0)
    for (std::size_t k = 0; k < buffered_; ++k)
      add_to_words(terms_[k]);
  buffered_ = 0;
}

ExactSum& ExactSum::operator+=(const ExactSum& more) {
  ExactSum other = more;
  other.flush_terms();
  other.propagate_carries();
  propagate_carries();
  for (std::size_t w = 0; w < words_.size(); ++w)
    words_[w] += other.words_[w];
  added_ = 1; // each word grew by less than one term can add
  not_finite_ += other.not_finite_;
  return *this;
}

std::vector<std::uint64_t> ExactSum::words() const {
  ExactSum sum = *this;
  sum.flush_terms();
  sum.propagate_carries();
  std::vector<std::uint64_t> words(sum.words_.begin(), sum.words_.end()); // a negative word modulo 2⁶⁴
  words.push_back(sum.not_finite_ == 0.0 ? 0 : 1);
  return words;
}

ExactSum ExactSum::of_words(std::span<const std::uint64_t> words) {
  ExactSum sum;
  assert(words.size() == sum.words_.size() + 1);
  for (std::size_t w = 0; w < sum.words_.size(); ++w)
    sum.words_[w] = static_cast<std::int64_t>(words[w]);
  sum.propagate_carries();
  if (words.back() > 0)
    sum.not_finite_ = std::numeric_limits<double>::quiet_NaN();
  return sum;
}

double ExactSum::value() const {
  ExactSum sum = *this;
  sum.flush_terms();
  if (!(sum.not_finite_ == 0.0))
    return sum.not_finite_;
  sum.propagate_carries();
  const bool negative = sum.words_.back() < 0;
  if (negative) {
    for (std::int64_t& word : sum.words_)
      word = -word;
    sum.propagate_carries();
  }
  std::size_t top = sum.words_.size() - 1;
  while (top > 1 && sum.words_[top] == 0)
    --top;
  const auto word = [&](std::size_t w) { return static_cast<std::uint64_t>(sum.words_[w]); };
  assert(word(top) < std::uint64_t{1} << 32);
  const std::uint64_t high = word(top) << 32 | word(top - 1);
  if (high == 0)
    return 0.0;
  // the first 64 bits; the last one is set if any lower bit is (sticky bit, for the rounding)
  const int zeros = std::countl_zero(high);
  std::uint64_t bits = high << zeros;
  if (top > 1)
    bits |= word(top - 2) >> (32 - zeros) | ((word(top - 2) << zeros & 0xFFFFFFFF) != 0);
  for (std::size_t w = 0; w + 2 < top; ++w)
    bits |= sum.words_[w] != 0;
  const double rounded = std::ldexp(static_cast<double>(bits), 32 * static_cast<int>(top - 1) - 1075 - zeros);
  return negative ? -rounded : rounded;
}

} // namespace keeler
