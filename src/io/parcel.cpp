#include "parcel.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <unistd.h>

namespace keeler {
namespace {

// Throws IoError after a failed system call, unless a signal interrupted it.
void require_only_interrupted() {
  if (errno != EINTR)
    throw IoError(std::string("a pipe failed: ") + std::strerror(errno));
}

void write_all(int descriptor, const std::byte* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0) {
      require_only_interrupted();
      continue;
    }
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

} // namespace

void Sender::flush() {
  write_all(descriptor_, buffer_.data(), buffer_.size());
  buffer_.clear();
}

void Sender::put(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(data);
  if (buffer_.size() + size > capacity)
    flush();
  if (size > capacity)
    write_all(descriptor_, bytes, size);
  else
    buffer_.insert(buffer_.end(), bytes, bytes + size);
}

void Receiver::take(void* data, std::size_t size) {
  using namespace std::chrono;
  if (size > left_)
    throw IoError("it yields more data than its size allows");
  left_ -= size;
  for (auto* at = static_cast<std::byte*>(data); size > 0;) {
    throw_if_interrupted();
    const auto left = duration_cast<milliseconds>(deadline_ - steady_clock::now());
    pollfd ready = {.fd = descriptor_, .events = POLLIN, .revents = 0};
    const int count = poll(&ready, 1, static_cast<int>(std::clamp<milliseconds::rep>(left.count(), 0, 1000)));
    if (count == 0 && left.count() <= 0)
      throw IoError(endless);
    if (count < 0)
      require_only_interrupted();
    if (count <= 0)
      continue;
    const ssize_t got = read(descriptor_, at, size);
    if (got == 0)
      throw ParcelEnds();
    if (got < 0) {
      require_only_interrupted();
      continue;
    }
    at += got;
    size -= static_cast<std::size_t>(got);
  }
}

std::size_t Receiver::take_count(std::size_t size) {
  assert(size > 0);
  std::uint64_t count = 0;
  receive(count);
  if (count > left_ / size)
    throw IoError("it yields more data than its size allows");
  return count;
}

} // namespace keeler
