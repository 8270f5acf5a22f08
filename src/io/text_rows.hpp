// Texts with a row per particle, written in pieces.
#pragma once

#include <keeler/core/interrupt.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace keeler::io {

/// Writes a text: `head`, then what append(buffer, k) appends for each row. Complete or not at all. Throws IoError.
template<class Append>
void write_rows(const std::filesystem::path& file, std::string_view head, std::size_t rows, const Append& append) {
  constexpr std::size_t piece = std::size_t{1} << 22; // bytes
  files::NewFile out(file);
  fmt::memory_buffer text;
  text.append(head.data(), head.data() + head.size());
  const auto write_text_so_far = [&] {
    throw_if_interrupted();
    out.write(std::as_bytes(std::span(text.data(), text.size())));
    text.clear();
  };
  for (std::size_t k = 0; k < rows; ++k) {
    append(text, k);
    if (text.size() >= piece)
      write_text_so_far();
  }
  write_text_so_far();
  out.keep();
}

} // namespace keeler::io
