#include <keeler/core/format.hpp>

#include <keeler/core/printable.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace keeler {
namespace {

bool is_continuation(unsigned char byte) {
  return (byte & 0xc0) == 0x80;
}

unsigned char byte_of(std::string_view text, std::size_t k) {
  return k < text.size() ? static_cast<unsigned char>(text[k]) : static_cast<unsigned char>(0);
}

// Returns the number of bytes of the first UTF-8 character (RFC 3629) of a text; 0 if it is invalid. Precondition: the
// text is not empty.
std::size_t character_at(std::string_view text) {
  assert(!text.empty());
  const unsigned char first = byte_of(text, 0), second = byte_of(text, 1);
  if (first < 0x80)
    return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4)
    return 0;
  for (std::size_t k = 1; k < length; ++k)
    if (!is_continuation(byte_of(text, k)))
      return 0;
  const bool too_long = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool no_character = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  return too_long || no_character ? 0 : length;
}

bool is_control(std::string_view character) {
  const unsigned char first = byte_of(character, 0);
  return first < 0x20 || first == 0x7f || (first == 0xc2 && byte_of(character, 1) < 0xa0);
}

// Replaces invalid UTF-8 and control characters, except those in `kept`, by '?'.
std::string printable(std::string_view text, std::string_view kept) {
  std::string all;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view character = text.substr(at, character_at(text.substr(at, 4)));
    const bool prints = !character.empty() && (!is_control(character) || kept.find(character) != kept.npos);
    all += prints ? character : "?";
    at += prints ? character.size() : 1;
  }
  return all;
}

} // namespace

std::string format_number(double value, int digits) {
  assert(digits > 0);
  std::string text = fmt::format("{:.{}g}", value, digits);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos)
    return text;
  const double rounded = std::strtod(text.c_str(), nullptr);
  if (std::fabs(rounded) >= 1.0 && std::fabs(rounded) < 1e7)
    return fmt::format("{:.0f}", rounded);
  const int power = std::atoi(text.c_str() + exponent + 1);
  return text.replace(exponent + 1, std::string::npos, std::to_string(power)); // 1e9, not 1e+09
}

std::string pluralize(std::uint64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_at(text.substr(at, 4));
    if (length == 0)
      return false;
    at += length;
  }
  return true;
}

std::string printable_text(std::string_view text) {
  return printable(text, "\n\t");
}

std::string printable_line(const std::string& line) {
  constexpr std::size_t max_size = 2000, end = 500;
  std::string text = printable(line, "");
  if (text.size() <= max_size)
    return text;
  std::size_t head = max_size - end, tail = text.size() - end;
  while (is_continuation(static_cast<unsigned char>(text[head])))
    --head;
  while (is_continuation(static_cast<unsigned char>(text[tail])))
    ++tail;
  return text.substr(0, head) + " [...] " + text.substr(tail);
}

} // namespace keeler
