// A 128-bit hash of data (XXH3) for checksums and state_hash. It detects accidents, not forgery. Its value depends on
// the bytes alone and is equal on all little-endian machines.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace keeler::io {

class Hash {
public:
  Hash();

  void add_bytes(std::span<const std::byte> bytes);

  /// Adds a number, or a struct of numbers without padding.
  template<class T> void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    add_bytes(std::as_bytes(std::span(&value, 1)));
  }

  /// Adds a text and its length, so that ("ab", "c") and ("a", "bc") differ.
  void add_text(std::string_view text);

  /// Returns 32 hexadecimal digits for all that was added so far; more may be added afterwards.
  std::string hex() const;

private:
  struct Free {
    void operator()(void* state) const;
  };
  std::unique_ptr<void, Free> state_;
};

} // namespace keeler::io
