#include <keeler/report/gnuplot.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <array>
#include <cassert>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keeler {
namespace {

constexpr int not_found = 127; // exit code, as in a shell

int run_in(const std::filesystem::path& folder, const std::string& terminal, const std::string& script, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::string program = "gnuplot", option = "-e", first = terminal, file = script;
  const std::array<char*, 5> arguments = {program.data(), option.data(), first.data(), file.data(), nullptr};
  pid_t process = 0;
  const int failure = posix_spawnp(&process, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0)
    return not_found;
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

} // namespace

std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : printable_line(text))
    quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

bool plot(const std::filesystem::path& folder, const std::string& name, const std::string& script, int width,
          int height) {
  assert(width > 0 && height > 0);
  write_text(folder / (name + ".gp"), script);
  const std::string png = fmt::format("set terminal pngcairo size {},{} font 'DejaVu Sans,11'", width, height);
  const std::string svg = fmt::format("set terminal svg size {},{} font 'DejaVu Sans,11'", width, height);
  for (const auto& [terminal, ending] : {std::pair(png, "png"), std::pair(svg, "svg")}) {
    NewFile picture(folder / fmt::format("{}.{}", name, ending));
    const int code = run_in(folder, terminal, name + ".gp", picture.descriptor()->number());
    if (code == not_found)
      return false;
    if (code != 0)
      throw IoError(
          fmt::format("gnuplot failed on '{}'; run it there to see the error", (folder / (name + ".gp")).string()));
    picture.keep();
  }
  return true;
}

} // namespace keeler
