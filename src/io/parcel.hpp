// Serialises values as plain bytes from one process to another. A class type defines
//   template<class Parcel, class T> void pass(Parcel& parcel, T& value) { parcel(value.one, value.other); }
// which serves both directions. The receiver does not trust the sender: malformed data is an error, and memory is
// allocated only up to the permitted number of bytes.
#pragma once

#include <keeler/core/vector.hpp>

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace keeler {

/// Types that can be copied as bytes and for which any bytes are a valid value.
template<class T>
concept PlainBytes = (std::is_arithmetic_v<T> && !std::same_as<T, bool>) || std::same_as<T, Vec3>;

/// Writes to a pipe, buffered. If the reader is gone, the process ends by SIGPIPE.
class Sender {
public:
  explicit Sender(int descriptor) : descriptor_(descriptor) { buffer_.reserve(capacity); }

  template<class... Part> void operator()(const Part&... part) { (send(part), ...); }
  /// Writes the buffer to the pipe. Call it after the last value: the destructor does not.
  void flush();

private:
  static constexpr std::size_t capacity = std::size_t{1} << 16;

  void put(const void* data, std::size_t size);

  template<PlainBytes T> void send(const T& value) { put(&value, sizeof value); }
  void send(const std::string& text) {
    send(std::uint64_t{text.size()});
    put(text.data(), text.size());
  }
  template<class T> void send(const std::vector<T>& list) {
    send(std::uint64_t{list.size()});
    if constexpr (PlainBytes<T>)
      put(list.data(), list.size() * sizeof(T));
    else
      for (const T& value : list)
        send(value);
  }
  template<class T> void send(const std::map<std::string, T>& map) {
    send(std::uint64_t{map.size()});
    for (const auto& [name, value] : map) {
      send(name);
      send(value);
    }
  }
  template<class T> void send(const T& value) { pass(*this, value); }

  int descriptor_;
  std::vector<std::byte> buffer_;
};

/// Reason of a timeout.
inline constexpr char endless[] = "reading it does not come to an end, so it is damaged; use another copy";

/// Thrown when the pipe closes before the parcel is complete.
struct ParcelEnds : std::exception {
  const char* what() const noexcept override { return "the parcel ends too soon"; }
};

/// Reads from a pipe what a Sender wrote.
class Receiver {
public:
  /// Accepts at most `max_bytes`, until the deadline.
  Receiver(int descriptor, std::size_t max_bytes, std::chrono::steady_clock::time_point deadline)
      : descriptor_(descriptor), left_(max_bytes), deadline_(deadline) {}

  template<class... Part> void operator()(Part&... part) { (receive(part), ...); }

private:
  /// Reads `size` bytes. Throws ParcelEnds; IoError at the deadline or beyond max_bytes; Interrupted.
  void take(void* data, std::size_t size);
  /// Reads the length of a list of elements of at least `size` bytes each. Precondition: size > 0.
  std::size_t take_count(std::size_t size);

  template<PlainBytes T> void receive(T& value) { take(&value, sizeof value); }
  void receive(std::string& text) {
    text.resize(take_count(1));
    take(text.data(), text.size());
  }
  template<class T> void receive(std::vector<T>& list) {
    if constexpr (PlainBytes<T>) {
      list.resize(take_count(sizeof(T)));
      take(list.data(), list.size() * sizeof(T));
    } else {
      list.clear();
      for (std::size_t left = take_count(sizeof(std::uint64_t)); left > 0; --left)
        receive(list.emplace_back());
    }
  }
  template<class T> void receive(std::map<std::string, T>& map) {
    for (std::size_t left = take_count(2 * sizeof(std::uint64_t)); left > 0; --left) {
      std::string name;
      receive(name);
      receive(map[std::move(name)]);
    }
  }
  template<class T> void receive(T& value) { pass(*this, value); }

  int descriptor_;
  std::size_t left_;
  std::chrono::steady_clock::time_point deadline_;
};

} // namespace keeler
