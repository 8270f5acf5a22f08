#include "zip_archive.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace keeler::io {

namespace {

// Signatures and sizes of the records (PKWARE's APPNOTE 6.3, 4.3.7, 4.3.12, 4.3.16).
constexpr std::uint32_t local_signature = 0x04034b50, entry_signature = 0x02014b50, end_signature = 0x06054b50;
constexpr std::size_t local_size = 30, entry_size = 46, end_size = 22, longest_comment = 0xFFFF;
constexpr std::uint64_t largest_zip = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint16_t zip_version = 20, stored = 0, first_of_1980 = 0x0021;

constexpr std::array<std::uint32_t, 256> crc_table = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    table[byte] = crc;
  }
  return table;
}();

// Appends a little-endian number.
template<class Number> void put_number(std::string& bytes, Number number) {
  for (std::size_t k = 0; k < sizeof(Number); ++k)
    bytes += static_cast<char>((number >> (8 * k)) & 0xFFU);
}

[[noreturn]] void fail_damaged(const std::string& file) {
  throw UsageError(fmt::format("{}: the archive is damaged or cut short; write it again by numpy.savez", file));
}

// A view of an archive with checked access.
class ZipBytes {
public:
  ZipBytes(std::string_view content, const std::string& file) : content_(content), file_(file) {}

  std::string_view piece(std::uint64_t at, std::uint64_t size) const {
    if (at > content_.size() || size > content_.size() - at)
      fail_damaged(file_);
    return content_.substr(at, size);
  }

  std::uint32_t number(std::uint64_t at, std::size_t bytes) const {
    assert(bytes <= 4);
    std::uint32_t value = 0;
    const std::string_view here = piece(at, bytes);
    for (std::size_t k = 0; k < bytes; ++k)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(here[k])) << (8 * k);
    return value;
  }

  std::uint64_t end_record() const {
    if (content_.size() < end_size)
      fail_damaged(file_);
    const std::size_t last = content_.size() - end_size;
    for (std::size_t back = 0; back <= std::min(longest_comment, last); ++back)
      if (number(last - back, 4) == end_signature)
        return last - back;
    fail_damaged(file_);
  }

private:
  std::string_view content_;
  const std::string& file_;
};

} // namespace

void Crc32::add(std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes)
    state_ = crc_table[(state_ ^ static_cast<std::uint32_t>(byte)) & 0xFFU] ^ (state_ >> 8U);
}

std::vector<std::pair<std::string, std::string_view>> zip_members(std::string_view content, const std::string& file) {
  const ZipBytes bytes(content, file);
  const std::uint64_t end = bytes.end_record();
  const std::uint32_t count = bytes.number(end + 10, 2);
  std::uint64_t at = bytes.number(end + 16, 4);
  std::vector<std::pair<std::string, std::string_view>> members;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (bytes.number(at, 4) != entry_signature)
      fail_damaged(file);
    const std::uint32_t method = bytes.number(at + 10, 2), crc = bytes.number(at + 16, 4),
                        packed = bytes.number(at + 20, 4), size = bytes.number(at + 24, 4),
                        name_length = bytes.number(at + 28, 2), local = bytes.number(at + 42, 4);
    const std::string name(bytes.piece(at + entry_size, name_length));
    if (method != stored)
      throw UsageError(
          fmt::format("{}: {} is compressed; write the file by numpy.savez, not savez_compressed", file, name));
    if (size == largest_zip || packed != size)
      throw UsageError(fmt::format("{}: {} has 4 GiB or more; write an HDF5 file instead", file, name));
    if (bytes.number(local, 4) != local_signature)
      fail_damaged(file);
    const std::uint64_t start =
        local + local_size + bytes.number(local + 26, 2) + std::uint64_t{bytes.number(local + 28, 2)};
    const std::string_view member = bytes.piece(start, size);
    Crc32 check;
    check.add(std::as_bytes(std::span(member)));
    if (check.value() != crc)
      fail_damaged(file);
    members.emplace_back(name, member);
    at += entry_size + name_length + bytes.number(at + 30, 2) + std::uint64_t{bytes.number(at + 32, 2)};
  }
  return members;
}

void ZipWriter::put(std::string_view bytes) {
  out_.write(std::as_bytes(std::span(bytes)));
  size_ += bytes.size();
}

void ZipWriter::add(const std::string& name, std::string_view head, std::span<const std::byte> content) {
  throw_if_interrupted();
  Crc32 crc;
  crc.add(std::as_bytes(std::span(head)));
  crc.add(content);
  const std::uint64_t size = head.size() + content.size();
  if (size_ + size + (std::uint64_t{1} << 16U) > largest_zip)
    throw UsageError(fmt::format("'{}' would have more than 4 GiB, which this format cannot; use --to hdf5", name_));
  std::string about; // that the record of the member and its entry in the directory share
  put_number(about, zip_version);
  put_number(about, std::uint16_t{0}); // flags
  put_number(about, stored);
  put_number(about, std::uint16_t{0}); // time of day
  put_number(about, first_of_1980);    // equal contents make equal files
  put_number(about, crc.value());
  put_number(about, static_cast<std::uint32_t>(size));
  put_number(about, static_cast<std::uint32_t>(size));
  put_number(about, static_cast<std::uint16_t>(name.size()));
  put_number(about, std::uint16_t{0}); // extra field

  put_number(directory_, entry_signature);
  put_number(directory_, zip_version);
  directory_ += about;
  put_number(directory_, std::uint16_t{0}); // comment
  put_number(directory_, std::uint16_t{0}); // disk
  put_number(directory_, std::uint16_t{0}); // internal attributes
  put_number(directory_, std::uint32_t{0}); // external ones
  put_number(directory_, static_cast<std::uint32_t>(size_));
  directory_ += name;
  ++count_;

  std::string local;
  put_number(local, local_signature);
  put(local + about + name);
  put(head);
  put({reinterpret_cast<const char*>(content.data()), content.size()});
}

void ZipWriter::finish() {
  std::string end;
  put_number(end, end_signature);
  put_number(end, std::uint32_t{0}); // disks
  put_number(end, count_);
  put_number(end, count_);
  put_number(end, static_cast<std::uint32_t>(directory_.size()));
  put_number(end, static_cast<std::uint32_t>(size_));
  put_number(end, std::uint16_t{0}); // comment
  put(directory_);
  put(end);
  out_.keep();
}

} // namespace keeler::io
