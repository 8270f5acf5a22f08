// An input taken apart from its front into small numbers and texts; behind its end there are zeros. So every input
// means something, and a change of one byte changes one thing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace keeler::fuzz {

class Draw {
public:
  explicit Draw(std::string_view input) : rest_(input) {}

  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

  std::uint8_t byte() {
    if (rest_.empty())
      return 0;
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }

  /// In [0, count).
  std::size_t below(std::size_t count) { return byte() % count; }

  /// In [0, 2^16).
  std::size_t place() {
    const std::size_t low = byte(), high = byte();
    return low + 256 * high;
  }

  /// At most 255 bytes.
  std::string_view bytes() {
    const std::size_t asked = byte(), size = std::min(asked, rest_.size());
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

private:
  std::string_view rest_;
};

} // namespace keeler::fuzz
