#include <keeler/runs/run_stage.hpp>

#include "run_folder.hpp"
#include "summarise.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/descriptor.hpp>
#include <keeler/io/checkpoint_folder.hpp>

#include <algorithm>
#include <charconv>
#include <span>
#include <string>

#include <fcntl.h>

namespace keeler::runs {
namespace {

constexpr std::size_t max_row = 4096; // bytes, more than any row has

// Returns the end of a text file, with at least one complete line if the file has any; empty if it cannot be read.
std::string tail_of(const std::filesystem::path& file) {
  try {
    const files::Descriptor opened(file, O_RDONLY);
    const std::size_t size = opened.size(), length = std::min(size, 2 * max_row);
    std::string tail(length, '\0');
    tail.resize(opened.read_at(size - length, std::as_writable_bytes(std::span(tail))));
    return tail;
  } catch (const IoError&) {
    return {};
  }
}

} // namespace

RunStage run_stage(const std::filesystem::path& folder) {
  std::error_code unknown;
  if (!std::filesystem::exists(folder, unknown) || std::filesystem::is_empty(folder, unknown))
    return RunStage::absent;
  if (says_finished(folder))
    return RunStage::finished;
  return io::list_checkpoints(folder).empty() ? RunStage::begun : RunStage::resumable;
}

std::int64_t last_recorded_step(const std::filesystem::path& folder) {
  const std::string tail = tail_of(RunFolder(folder).series());
  const std::size_t end = tail.rfind('\n');
  if (end == std::string::npos || end == 0)
    return 0;
  const std::size_t line_break = tail.rfind('\n', end - 1);
  const std::size_t begin = line_break == std::string::npos ? 0 : line_break + 1;
  std::int64_t step = 0;
  std::from_chars(tail.data() + begin, tail.data() + end, step); // stays 0 if the line is the header
  return step;
}

} // namespace keeler::runs
