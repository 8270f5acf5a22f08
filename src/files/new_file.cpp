#include <keeler/files/new_file.hpp>

#include "waiting.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/naming_guard.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <random>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace keeler::files {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view mark = ".keeler-", ending = ".tmp";
constexpr std::size_t digits = 16, longest_name = 255;

std::string random_digits() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

// Returns the name of a file, truncated so that the temporary name fits the file system's limit.
std::string beginning_of(const fs::path& file) {
  return file.filename().string().substr(0, longest_name - mark.size() - digits - ending.size());
}

fs::path temporary_of(const fs::path& file) {
  return folder_of(file) / fmt::format("{}{}{}{}", beginning_of(file), mark, random_digits(), ending);
}

bool is_regular(int descriptor, struct stat& status) {
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

// Removes a temporary file unless a writer holds its lock. A file with several hard links is not a temporary one.
void remove_if_left_over(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0)
    return;
  struct stat status = {};
  if (is_regular(descriptor, status) && status.st_uid == geteuid() && status.st_nlink == 1 &&
      flock(descriptor, LOCK_EX | LOCK_NB) == 0)
    ::unlink(file.c_str());
  ::close(descriptor);
}

// Locks a file that was just created. Returns false if another process removed it before, as a left-over.
bool lock(int descriptor) {
  flock(descriptor, LOCK_EX); // on file systems without locks, left-overs are never removed
  struct stat status = {};
  return fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

std::optional<unsigned> mode_of(const fs::path& file) {
  struct stat status = {};
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return std::nullopt;
  return status.st_mode & 0777u;
}

// Returns the descriptor number in a path "/proc/123/fd/1" of this process.
std::optional<int> descriptor_at(const fs::path& path) {
  std::error_code unknown;
  const std::string folder = fs::canonical(folder_of(path), unknown).string();
  const std::string name = path.filename().string();
  if (unknown || !folder.starts_with(fmt::format("/proc/{}/", getpid())) || !folder.ends_with("/fd"))
    return std::nullopt;
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc{} && end == name.data() + name.size() ? std::optional(number) : std::nullopt;
}

// Opens a stream; waits until a pipe has a reader.
int open_stream(const fs::path& name) {
  std::error_code none;
  const bool waits = fs::is_fifo(name, none);
  for (;;) {
    const int number = ::open(name.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (number >= 0)
      fcntl(number, F_SETFL, O_WRONLY); // blocking writes: terminals accept a part at a time
    if (number >= 0 || (errno != EINTR && !(waits && errno == ENXIO)))
      return number;
    require_patience(name);
    ::poll(nullptr, 0, patience_ms);
  }
}

// Opens a stream, or duplicates a descriptor of this process. Its flags are not changed: others may share it.
std::shared_ptr<Descriptor> connect_stream(const fs::path& name) {
  const std::optional<int> named = descriptor_named(name);
  if (named == STDOUT_FILENO)
    std::fflush(stdout);
  const int number = named ? fcntl(*named, F_DUPFD_CLOEXEC, 0) : open_stream(name);
  return std::make_shared<Descriptor>(number, name);
}

} // namespace

std::optional<int> descriptor_named(const fs::path& name) {
  constexpr int max_links = 40; // as in the kernel
  fs::path path = name;
  for (int link = 0; link < max_links; ++link) {
    if (const std::optional<int> number = descriptor_at(path))
      return number;
    std::error_code none;
    const fs::path target = fs::read_symlink(path, none);
    if (none)
      return std::nullopt;
    path = folder_of(path) / target; // an absolute target replaces the path
  }
  return std::nullopt;
}

bool is_stream(const fs::path& name) {
  std::error_code none;
  const fs::file_status status = fs::status(name, none);
  return descriptor_named(name) || (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status));
}

void refuse_stream(const fs::path& name, const std::string& format) {
  if (is_stream(name))
    throw UsageError(fmt::format("'{}' cannot take {} (it is not a file on a disk, and the format needs random "
                                 "access); name a file",
                                 name.string(), format));
}

NewFile::NewFile(fs::path file) : file_(std::move(file)) {
  if (is_stream(file_)) {
    out_ = connect_stream(file_);
    return;
  }
  const std::string final_name = beginning_of(file_);
  remove_left_overs(folder_of(file_), [&](std::string_view name) { return name == final_name; });
  replaced_mode_ = mode_of(file_);
  const mode_t mode = replaced_mode_ ? 0600 : 0666;
  for (;;) {
    temporary_ = temporary_of(file_);
    const int number =
        ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode); // NOLINT: open has these
    if (number < 0 && (errno == EEXIST || errno == EINTR))
      continue;
    if (number < 0)
      temporary_.clear();
    out_ = std::make_shared<Descriptor>(number, file_);
    if (lock(number))
      return;
  }
}

NewFile::~NewFile() {
  if (!temporary_.empty())
    ::unlink(temporary_.c_str());
}

void NewFile::write(std::span<const std::byte> content) {
  if (!temporary_.empty())
    return out_->write_all(content);
  while (!content.empty()) {
    await(out_->number(), POLLOUT, file_);
    const std::span<const std::byte> piece = content.first(std::min<std::size_t>(content.size(), PIPE_BUF));
    out_->write_all(piece);
    content = content.subspan(piece.size());
  }
}

void NewFile::keep() {
  if (temporary_.empty())
    return out_->close();
  if (replaced_mode_)
    out_->set_mode(*replaced_mode_);
  out_->sync();
  NamingGuard::run_check();
  std::error_code error;
  fs::rename(temporary_, file_, error);
  if (error)
    throw IoError(fmt::format("cannot write '{}': {}", file_.string(), error.message()));
  temporary_.clear();
  Descriptor(folder_of(file_), O_RDONLY | O_DIRECTORY).sync();
}

std::optional<std::string_view> unfinished_name(std::string_view name) {
  const std::size_t tail = mark.size() + digits + ending.size();
  if (name.size() <= tail || !name.ends_with(ending))
    return std::nullopt;
  const std::string_view number = name.substr(name.size() - ending.size() - digits, digits);
  const std::string_view before = name.substr(name.size() - tail, mark.size());
  const bool is_one = before == mark && number.find_first_not_of("0123456789abcdef") == number.npos;
  return is_one ? std::optional(name.substr(0, name.size() - tail)) : std::nullopt;
}

void remove_left_overs(const fs::path& folder, const std::function<bool(std::string_view name)>& accept) {
  assert(accept);
  std::error_code unknown; // nothing is removed from a folder that cannot be listed
  for (fs::directory_iterator entry(folder, unknown), end; !unknown && entry != end; entry.increment(unknown)) {
    const std::string file = entry->path().filename().string();
    if (const std::optional<std::string_view> name = unfinished_name(file); name && accept(*name))
      remove_if_left_over(entry->path());
  }
}

} // namespace keeler::files
