// Values as plain bytes, from one process to another. A type of several parts has a function
//   template<class Parcel, class T> void pass(Parcel& parcel, T& value) { parcel(value.one, value.other); }
// beside it, which serves both ways. The receiver trusts nobody: what does not fit is an error, and memory is taken
// only for as many bytes as may come.
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

/// Whose bytes are its value, and any bytes are a value of it.
template<class T>
concept PlainBytes = (std::is_arithmetic_v<T> && !std::same_as<T, bool>) || std::same_as<T, Vec3>;

/// Writes to a pipe. A reader that is gone ends the process (SIGPIPE).
class Sender {
public:
  explicit Sender(int descriptor) : descriptor_(descriptor) { buffer_.reserve(room); }

  template<class... Part> void operator()(const Part&... part) { (send(part), ...); }
  /// What was passed is in the pipe only after this.
  void flush();

private:
  static constexpr std::size_t room = std::size_t{1} << 16;

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

/// Why a sender was given up.
inline constexpr char endless[] = "reading it does not come to an end, so it is damaged; use another copy";

/// The other end did not send all that it began.
struct ParcelEnds : std::exception {
  const char* what() const noexcept override { return "the parcel ends too soon"; }
};

class Receiver {
public:
  /// Of at most `most` bytes, which come before the deadline.
  Receiver(int descriptor, std::size_t most, std::chrono::steady_clock::time_point deadline)
      : descriptor_(descriptor), left_(most), deadline_(deadline) {}

  template<class... Part> void operator()(Part&... part) { (receive(part), ...); }

private:
  /// Throws ParcelEnds; IoError when it is too late or too much; Interrupted.
  void take(void* data, std::size_t size);
  /// Of things that have at least `size` bytes each.
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
