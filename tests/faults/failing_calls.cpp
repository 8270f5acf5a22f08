// A library that is loaded before the C library (LD_PRELOAD) and lets one system call on files fail, or kills the
// process at it.
//   KEELER_FAULT_FOLDER  only calls on files and folders whose path begins so are counted
//   KEELER_FAULT_AT      which of them fails, from 1; 0: none
//   KEELER_FAULT         kill: SIGKILL before the call · torn: half of what it writes, then SIGKILL ·
//                        nospace: ENOSPC after half · io: EIO
//   KEELER_FAULT_COUNT   a file that gets the number of calls when the process ends
//   KEELER_FAULT_CLOCK   1: the wall clock jumps by years between any two looks at it
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

std::string setting(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

struct Settings {
  std::string folder = setting("KEELER_FAULT_FOLDER"), fault = setting("KEELER_FAULT"),
              count_file = setting("KEELER_FAULT_COUNT");
  long at = std::atol(setting("KEELER_FAULT_AT").c_str());
  bool jumps = setting("KEELER_FAULT_CLOCK") == "1";
};

// Never destroyed: files are closed after the destructors of this library.
const Settings& settings() {
  static const Settings* const read = new Settings;
  return *read;
}

long calls = 0;
std::array<bool, 1024> ours{}; // descriptors of files of the folder

template<class Function> Function* original(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_ours(int descriptor) {
  return descriptor >= 0 && static_cast<std::size_t>(descriptor) < ours.size() &&
         ours[static_cast<std::size_t>(descriptor)];
}

bool is_ours(const char* path) {
  return !settings().folder.empty() && std::string_view(path).starts_with(settings().folder);
}

// Counts a call; whether it is the one.
bool is_due() {
  return ++calls == settings().at;
}

int failed() {
  if (settings().fault == "kill" || settings().fault == "torn")
    raise(SIGKILL);
  errno = settings().fault == "nospace" ? ENOSPC : EIO;
  return -1;
}

template<class Call> auto unless_due(bool counted, const Call& call) -> decltype(call()) {
  return counted && is_due() ? static_cast<decltype(call())>(failed()) : call();
}

// write(part) writes so much of it.
template<class Write> ssize_t written(int descriptor, size_t size, const Write& write) {
  if (!is_ours(descriptor) || !is_due())
    return write(size);
  if (settings().fault == "torn" || settings().fault == "nospace") {
    const ssize_t half = write(size / 2);
    if (half > 0 && settings().fault == "nospace") {
      --calls; // the next write of the same descriptor is the one that has no room
      return half;
    }
  }
  return failed();
}

int opened(const char* name, const char* path, int flags, mode_t mode) {
  const bool counted = is_ours(path) && ((flags & O_ACCMODE) != O_RDONLY || (flags & O_DIRECTORY) != 0);
  const int descriptor =
      unless_due(counted, [&] { return original<int(const char*, int, ...)>(name)(path, flags, mode); });
  if (descriptor >= 0 && static_cast<std::size_t>(descriptor) < ours.size())
    ours[static_cast<std::size_t>(descriptor)] = counted;
  return descriptor;
}

mode_t mode_in(int flags, va_list rest) {
  return (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
}

time_t jumped(time_t now) {
  static time_t looks = 0;
  constexpr time_t year = 31557600;
  return settings().jumps ? now + (++looks % 2 == 0 ? -10 : 5) * year : now;
}

struct CountAtExit {
  ~CountAtExit() {
    if (settings().count_file.empty())
      return;
    const std::string text = std::to_string(calls);
    const int file =
        original<int(const char*, int, ...)>("open")(settings().count_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file >= 0 && original<ssize_t(int, const void*, size_t)>("write")(file, text.data(), text.size()) > 0)
      original<int(int)>("close")(file);
  }
} count_at_exit;

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_in(flags, rest);
  va_end(rest);
  return opened("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_in(flags, rest);
  va_end(rest);
  return opened("open64", path, flags, mode);
}

ssize_t write(int descriptor, const void* content, size_t size) {
  return written(descriptor, size, [&](size_t part) {
    return original<ssize_t(int, const void*, size_t)>("write")(descriptor, content, part);
  });
}

ssize_t pwrite(int descriptor, const void* content, size_t size, off_t place) {
  return written(descriptor, size, [&](size_t part) {
    return original<ssize_t(int, const void*, size_t, off_t)>("pwrite")(descriptor, content, part, place);
  });
}

int fsync(int descriptor) {
  return unless_due(is_ours(descriptor), [&] { return original<int(int)>("fsync")(descriptor); });
}

int ftruncate(int descriptor, off_t size) {
  return unless_due(is_ours(descriptor), [&] { return original<int(int, off_t)>("ftruncate")(descriptor, size); });
}

int close(int descriptor) {
  const bool counted = is_ours(descriptor);
  if (counted)
    ours[static_cast<std::size_t>(descriptor)] = false;
  const bool due = counted && is_due() && settings().fault != "nospace";
  const int result = due && settings().fault != "io" ? failed() : original<int(int)>("close")(descriptor);
  return due ? failed() : result;
}

int rename(const char* from, const char* to) {
  return unless_due(is_ours(from), [&] { return original<int(const char*, const char*)>("rename")(from, to); });
}

int remove(const char* path) {
  return unless_due(is_ours(path), [&] { return original<int(const char*)>("remove")(path); });
}

int unlink(const char* path) {
  return unless_due(is_ours(path), [&] { return original<int(const char*)>("unlink")(path); });
}

int mkdir(const char* path, mode_t mode) {
  return unless_due(is_ours(path), [&] { return original<int(const char*, mode_t)>("mkdir")(path, mode); });
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = original<int(clockid_t, struct timespec*)>("clock_gettime")(clock, now);
  if (result == 0 && clock == CLOCK_REALTIME)
    now->tv_sec = jumped(now->tv_sec);
  return result;
}

time_t time(time_t* now) {
  struct timespec t {};
  clock_gettime(CLOCK_REALTIME, &t);
  if (now)
    *now = t.tv_sec;
  return t.tv_sec;
}

} // extern "C"
