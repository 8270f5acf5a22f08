#include "mp4.hpp"

#include <keeler/core/error.hpp>
#include <keeler/render/movie.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler::render {
namespace {

// The descriptor of the output file in ffmpeg.
constexpr int movie_descriptor = 3;

std::vector<std::string> arguments(int width, int height) {
  return {"ffmpeg", "-nostdin", "-loglevel", "error", "-xerror", "-y",
          // Cairo's pixels, blue first, the fourth byte unused.
          "-f", "rawvideo", "-pixel_format", "bgr0", "-video_size", fmt::format("{}x{}", width, height), "-framerate",
          std::to_string(movie_frames_per_second), "-i", "pipe:0",
          // This chroma format needs even dimensions.
          "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-pix_fmt",
          "yuv420p", "-f", "mp4", fmt::format("file:/proc/self/fd/{}", movie_descriptor)};
}

} // namespace

Mp4::Mp4(const std::filesystem::path& file, int width, int height)
    : name_(file), file_(file), messages_(std::tmpfile()) {
  int ends[2];
  if (!messages_ || pipe2(ends, O_CLOEXEC) != 0)
    throw IoError(fmt::format("cannot write the movie '{}': {}", name_.string(), std::strerror(errno)));
  std::vector<std::string> words = arguments(width, height);
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(messages_.get()), STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, file_.descriptor()->number(), movie_descriptor);
  posix_spawnattr_t apart; // a new process group: Ctrl-C reaches this program, which then ends ffmpeg
  posix_spawnattr_init(&apart);
  posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETPGROUP);
  const int error = posix_spawnp(&process_, "ffmpeg", &actions, &apart, pointers.data(), environ);
  posix_spawnattr_destroy(&apart);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (error != 0) {
    process_ = -1;
    close(pipe_);
    throw IoError(
        fmt::format("cannot write the movie '{}': ffmpeg does not start: {}", name_.string(), std::strerror(error)));
  }
}

Mp4::~Mp4() {
  if (process_ < 0)
    return;
  kill(process_, SIGKILL); // otherwise it would finish an incomplete movie
  ended_well();
}

// Closes the pipe, which ends the movie, and waits. Returns true if ffmpeg succeeded. Precondition: ffmpeg is running.
bool Mp4::ended_well() {
  assert(process_ > 0);
  close(pipe_);
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string Mp4::first_message() const {
  char line[400] = "";
  std::rewind(messages_.get());
  if (std::fgets(line, sizeof line, messages_.get()) == nullptr)
    return "nothing";
  return std::string(line, std::strcspn(line, "\n"));
}

void Mp4::fail() const {
  throw IoError(fmt::format("cannot write the movie '{}'; ffmpeg says: {}; choose a folder that is writable and has "
                            "room",
                            name_.string(), first_message()));
}

void Mp4::add(plot::Page& page) {
  std::span<const std::byte> pixels = page.pixels();
  while (!pixels.empty()) {
    const ssize_t written = write(pipe_, pixels.data(), pixels.size());
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0) {
      ended_well();
      fail();
    }
    pixels = pixels.subspan(static_cast<std::size_t>(written));
  }
}

void Mp4::finish() {
  if (!ended_well())
    fail();
  file_.keep();
}

} // namespace keeler::render
