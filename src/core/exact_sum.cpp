#include <keeler/core/exact_sum.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler {
namespace {

constexpr int max_taken = 1024; // of less than 2⁵² each, on the 32 bits that carry() leaves

} // namespace

// Leaves 32 bits in each word, of which the topmost has the sign: then each sum has one form.
void ExactSum::carry() {
  for (std::size_t w = 0; w + 1 < words_.size(); ++w) {
    const std::int64_t over = words_[w] >> 32;
    words_[w] -= over * (std::int64_t{1} << 32);
    words_[w + 1] += over;
  }
  taken_ = 0;
}

void ExactSum::take(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const auto exponent = static_cast<std::uint32_t>(bits >> 52) & 0x7FF;
  if (exponent == 0x7FF) {
    not_finite_ += term;
    return;
  }
  // a subnormal has the scale of the least exponent, and no hidden bit
  const std::uint32_t scale = exponent == 0 ? 1 : exponent;
  const std::uint64_t mantissa = (bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{exponent != 0} << 52;
  const std::uint32_t word = scale / 32, shift = scale % 32;
  const std::int64_t sign = bits >> 63 != 0 ? -1 : 1;
  words_[word] += sign * static_cast<std::int64_t>((mantissa << shift) & 0xFFFFFFFF);
  words_[word + 1] += sign * static_cast<std::int64_t>(mantissa >> (32 - shift));
  if (++taken_ == max_taken)
    carry();
}

// Each term is cut at two units. Sums of the upper and of the middle parts have less than 53 bits above their unit, so
// plain additions are exact, in any order. What is left of a term below both is taken by itself; few have it. `sizes`
// is Σ |term|.
void ExactSum::take_in_parts(double sizes) {
  const double upper_unit = std::ldexp(1.0, std::ilogb(sizes) - 49), lower_unit = 0x1p-46 * upper_unit;
  static_assert(max_terms <= 128); // 2⁷ times half an upper unit are 2⁵² lower ones
  // added to a number, these leave no bits below the unit
  const double upper_cut = 0x1.8p52 * upper_unit, lower_cut = 0x1.8p52 * lower_unit;
  double upper = 0.0, middle = 0.0, left = 0.0;
#pragma omp simd reduction(+ : upper, middle, left)
  for (std::size_t k = 0; k < waiting_; ++k) {
    const double high = (terms_[k] + upper_cut) - upper_cut, below = terms_[k] - high;
    const double mid = (below + lower_cut) - lower_cut;
    upper += high;
    middle += mid;
    terms_[k] = below - mid;
    left += std::fabs(terms_[k]);
  }
  take(upper);
  take(middle);
  if (left > 0.0)
    for (std::size_t k = 0; k < waiting_; ++k)
      take(terms_[k]);
}

void ExactSum::take_terms() {
  double sizes = 0.0;
#pragma omp simd reduction(+ : sizes)
  for (std::size_t k = 0; k < waiting_; ++k)
    sizes += std::fabs(terms_[k]);
  if (sizes > 0x1p-800 && sizes < 0x1p800)
    take_in_parts(sizes);
  else if (sizes != 0.0)
    for (std::size_t k = 0; k < waiting_; ++k)
      take(terms_[k]);
  waiting_ = 0;
}

ExactSum& ExactSum::operator+=(const ExactSum& more) {
  ExactSum other = more;
  other.take_terms();
  other.carry();
  carry();
  for (std::size_t w = 0; w < words_.size(); ++w)
    words_[w] += other.words_[w];
  taken_ = 1; // less than a term
  not_finite_ += other.not_finite_;
  return *this;
}

std::vector<std::uint64_t> ExactSum::words() const {
  ExactSum size = *this;
  size.take_terms();
  size.carry();
  std::vector<std::uint64_t> words(size.words_.begin(), size.words_.end()); // of the sign modulo 2⁶⁴
  words.push_back(size.not_finite_ == 0.0 ? 0 : 1);
  return words;
}

ExactSum ExactSum::of_words(std::span<const std::uint64_t> words) {
  ExactSum sum;
  assert(words.size() == sum.words_.size() + 1);
  for (std::size_t w = 0; w < sum.words_.size(); ++w)
    sum.words_[w] = static_cast<std::int64_t>(words[w]);
  sum.carry();
  if (words.back() > 0)
    sum.not_finite_ = std::numeric_limits<double>::quiet_NaN();
  return sum;
}

double ExactSum::value() const {
  ExactSum size = *this;
  size.take_terms();
  if (!(size.not_finite_ == 0.0))
    return size.not_finite_;
  size.carry();
  const bool negative = size.words_.back() < 0;
  if (negative) {
    for (std::int64_t& word : size.words_)
      word = -word;
    size.carry();
  }
  std::size_t top = size.words_.size() - 1;
  while (top > 1 && size.words_[top] == 0)
    --top;
  const auto word = [&](std::size_t w) { return static_cast<std::uint64_t>(size.words_[w]); };
  assert(word(top) < std::uint64_t{1} << 32);
  const std::uint64_t high = word(top) << 32 | word(top - 1);
  if (high == 0)
    return 0.0;
  // the first 64 bits; what lies below them is told by the last one, for the rounding
  const int zeros = std::countl_zero(high);
  std::uint64_t bits = high << zeros;
  if (top > 1)
    bits |= word(top - 2) >> (32 - zeros) | ((word(top - 2) << zeros & 0xFFFFFFFF) != 0);
  for (std::size_t w = 0; w + 2 < top; ++w)
    bits |= size.words_[w] != 0;
  const double rounded = std::ldexp(static_cast<double>(bits), 32 * static_cast<int>(top - 1) - 1075 - zeros);
  return negative ? -rounded : rounded;
}

} // namespace keeler
