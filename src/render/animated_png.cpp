// Animated PNG: the chunks of single PNGs, combined according to the PNG specification, third edition (W3C, 2025),
// sections acTL, fcTL and fdAT. Programs without support for animation show the first frame.
#include "movie_file.hpp"

#include <keeler/files/new_file.hpp>
#include <keeler/render/movie.hpp>

#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace keeler {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t signature = 8, chunk_overhead = 12; // bytes; length, name and CRC of a chunk

// The table of PNG's CRC-32, for each value of a byte.
constexpr std::array<std::uint32_t, 256> crc_table = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    table[n] = n;
    for (int bit = 0; bit < 8; ++bit)
      table[n] = table[n] & 1 ? 0xedb88320u ^ table[n] >> 1 : table[n] >> 1;
  }
  return table;
}();

std::uint32_t crc(std::span<const std::byte> bytes) {
  std::uint32_t c = 0xffffffffu;
  for (const std::byte byte : bytes)
    c = crc_table[(c ^ static_cast<std::uint32_t>(byte)) & 0xff] ^ c >> 8;
  return ~c;
}

// Appends a big-endian number.
void put(Bytes& to, std::uint32_t value, int bytes = 4) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    to.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const std::byte byte : bytes.subspan(at, 4))
    value = value << 8 | static_cast<std::uint32_t>(byte);
  return value;
}

void put_chunk(Bytes& to, std::string_view name, std::span<const std::byte> content) {
  assert(name.size() == 4);
  put(to, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = to.size();
  for (const char letter : name)
    to.push_back(static_cast<std::byte>(letter));
  to.insert(to.end(), content.begin(), content.end());
  put(to, crc(std::span(to).subspan(begin)));
}

class AnimatedPng : public MovieFile {
public:
  AnimatedPng(const std::filesystem::path& file, std::size_t frames) : frames_(frames), out_(file) {}

  void add(Page& page) override;
  void finish() override;

private:
  // acTL: number of frames; 0 plays means an endless loop.
  void put_animation(Bytes& to) const {
    Bytes content;
    put(content, static_cast<std::uint32_t>(frames_));
    put(content, 0);
    put_chunk(to, "acTL", content);
  }

  // fcTL: sequence number, size, position, duration as a fraction, and replacement of the previous frame.
  void put_control(Bytes& to, const Page& page) {
    Bytes content;
    for (const std::uint32_t value :
         {sequence_++, static_cast<std::uint32_t>(page.width()), static_cast<std::uint32_t>(page.height()), 0u, 0u})
      put(content, value);
    put(content, 1, 2);
    put(content, movie_frames_per_second, 2);
    put(content, 0, 2);
    put_chunk(to, "fcTL", content);
  }

  std::size_t frames_, added_ = 0;
  std::uint32_t sequence_ = 0;
  NewFile out_;
};

void AnimatedPng::add(Page& page) {
  assert(added_ < frames_);
  const Bytes png = page.png();
  const std::span<const std::byte> all(png);
  Bytes to;
  if (added_ == 0) { // signature and header come before the pixels
    const std::size_t header = signature + chunk_overhead + number_at(all, signature);
    to.insert(to.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(header));
    put_animation(to);
  }
  put_control(to, page);
  for (std::size_t at = signature; at < all.size();) {
    const std::size_t length = number_at(all, at);
    const std::string_view name(reinterpret_cast<const char*>(all.data()) + at + 4, 4);
    const auto content = all.subspan(at + 8, length);
    if (name == "IDAT" && added_ == 0)
      put_chunk(to, name, content);
    else if (name == "IDAT") {
      Bytes numbered;
      put(numbered, sequence_++);
      numbered.insert(numbered.end(), content.begin(), content.end());
      put_chunk(to, "fdAT", numbered);
    }
    at += chunk_overhead + length;
  }
  out_.write(to);
  ++added_;
}

void AnimatedPng::finish() {
  assert(added_ == frames_);
  Bytes end;
  put_chunk(end, "IEND", {});
  out_.write(end);
  out_.keep();
}

} // namespace

std::unique_ptr<MovieFile> new_animated_png(const std::filesystem::path& file, std::size_t frames) {
  return std::make_unique<AnimatedPng>(file, frames);
}

} // namespace keeler
