// keeler view: shows a run while it goes on, a run's folder or a snapshot, in a browser.
#include "command.hpp"
#include "common_options.hpp"
#include "messages.hpp"
#include "print.hpp"
#include "progress_line.hpp"
#include "results.hpp"
#include "scene_arguments.hpp"
#include "signals.hpp"
#include "temporary_folder.hpp"

#include <keeler/core/format.hpp>
#include <keeler/files/files.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/live_view/live_view.hpp>
#include <keeler/runs/run_folder.hpp>
#include <keeler/runs/run_view.hpp>

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <hdf5.h>
#include <spawn.h>
#include <unistd.h>

namespace keeler::cli {
namespace {

namespace fs = std::filesystem;
using live_view::LiveView, live_view::Stage;

constexpr int max_port = 65535;

struct ViewArguments {
  SceneArguments scene; // its path may name a folder or a snapshot as well
  std::optional<std::string> folder, from;
  bool resume = false, force = false, open = false;
  int port = 0;
  ThreadOption threads;
  TalkOption talk;
};

bool is_snapshot(const fs::path& path) {
  return fs::is_regular_file(path) && H5Fis_hdf5(path.c_str()) > 0;
}

// Refuses options of runs where nothing is run.
void refuse_run_options(const ViewArguments& view, const std::string& what) {
  for (const auto& [given, name] : {std::pair{view.folder.has_value(), "--output"},
                                    {view.from.has_value(), "--from"},
                                    {view.force, "--force"},
                                    {!view.scene.overrides.empty(), "--set"}})
    if (given)
      throw UsageError(fmt::format("{} is for a scene, and '{}' is {}, which is only shown; leave it out", name,
                                   view.scene.path, what));
}

// Opens the page by a file that leads to it and that only this user can read: other users see the arguments of
// processes, and the address lets in whoever knows it.
void open_browser(const std::string& address, const TemporaryFolder& place, const TalkOption& talk) {
  const fs::path file = place.path() / "view.html";
  files::write_text(file,
                    fmt::format("<!DOCTYPE html>\n<meta http-equiv=\"refresh\" content=\"0; url={}\">\n", address));
  std::string program = "xdg-open", name = file.string();
  char* const words[] = {program.data(), name.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, words, environ) != 0)
    talk.notice()("there is no xdg-open to open a browser; open the address yourself");
}

class Viewing {
public:
  Viewing(const ViewArguments& arguments, live_view::ViewOptions options)
      : view_(with_port(std::move(options), arguments.port)) {
    print("{}\n", view_.address());
    std::fflush(stdout);
    arguments.talk.notice()("open this address in a browser of this machine; Ctrl-C ends the view");
    if (arguments.open)
      open_browser(view_.address(), place_.emplace("keeler-view"), arguments.talk);
  }

  LiveView& view() { return view_; }

  // Shows until a signal comes.
  static void wait() {
    while (!requests_from_signals().stop)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }

private:
  static live_view::ViewOptions with_port(live_view::ViewOptions options, int port) {
    options.port = port;
    return options;
  }

  LiveView view_;
  std::optional<TemporaryFolder> place_; // of the file that leads to the page
};

ExitCode show_files(const ViewArguments& arguments, const fs::path& path) {
  if (fs::is_directory(path))
    static_cast<void>(runs::view_run(path)); // is it a run?
  else
    static_cast<void>(io::read_snapshot(path));
  Viewing viewing(arguments,
                  {.title = path.filename().empty() ? path.parent_path().filename().string() : path.filename().string(),
                   .path = path,
                   .stop = {}});
  Viewing::wait();
  return ExitCode::done;
}

// Runs or resumes into the folder, with the page.
ExitCode show_run(const ViewArguments& arguments, const Scene& scene, const fs::path& folder, bool is_kept,
                  const std::vector<std::string>& words) {
  runs::RunRequests& asked = requests_from_signals();
  if (!arguments.resume) { // before there is a page
    const runs::RunFolder place(folder);
    if (!arguments.force)
      place.refuse_if_occupied();
    place.require_writable();
  }
  Viewing viewing(arguments, {.title = scene.title.empty() ? arguments.scene.path : scene.title,
                              .path = folder,
                              .stop = [&asked] { asked.stop = true; },
                              .stage = Stage::starting});
  LiveView& view = viewing.view();
  const auto ends = [&asked] { return asked.stop || asked.give_up; };
  runs::RunResult result;
  {
    ProgressLine line(arguments.talk);
    runs::RunOptions options;
    options.folder = folder;
    options.force = arguments.force;
    options.arguments = words;
    options.notice = arguments.talk.notice();
    options.start_progress = [&](const initial_conditions::StartProgress& progress) {
      line.show(progress);
      view.set_stage(Stage::starting,
                     fmt::format("the initial state is being made: {:.0f} %", 100.0 * progress.fraction));
    };
    options.progress = [&line](const runs::RunProgress& progress) { line.show(progress); };
    bool is_first = true;
    options.observe = [&](const Simulation& simulation) {
      if (std::exchange(is_first, false))
        view.set_stage(Stage::running, "");
      view.at_boundary(simulation, scene);
      view.wait(simulation, scene, ends);
    };
    result = arguments.resume ? resume_run(options, asked) : start_run(scene, options, asked);
  }
  if (result.finished) {
    view.set_stage(Stage::finished, "the run has finished; Ctrl-C in its terminal ends this view");
    arguments.talk.notice()("the run has finished; Ctrl-C ends the view");
    Viewing::wait();
    return ExitCode::done;
  }
  const std::string how =
      is_kept ? fmt::format("stopped at step {} with a checkpoint; continue with \"keeler view {} --resume\" or \"{}\"",
                            result.step, folder.string(), result.resume_command)
              : fmt::format("stopped at step {}; without -o nothing is kept", result.step);
  view.set_stage(Stage::stopped, how);
  say(how);
  view.linger();
  return is_kept ? ExitCode::stopped : ExitCode::done;
}

ExitCode view(const ViewArguments& arguments, const std::vector<std::string>& words) {
  arguments.threads.apply();
  arguments.talk.say_program();
  const fs::path path = arguments.scene.path;
  if (fs::is_directory(path)) {
    refuse_run_options(arguments, "a folder");
    return arguments.resume ? show_run(arguments, scene::load_stored_scene(path / "scene.toml"), path, true, words)
                            : show_files(arguments, path);
  }
  if (arguments.resume)
    throw UsageError(
        fmt::format("--resume continues a run, and '{}' is not a folder; name the folder of a run", path.string()));
  if (is_snapshot(path)) {
    refuse_run_options(arguments, "a snapshot");
    return show_files(arguments, path);
  }
  const Scene scene = arguments.scene.load(arguments.from);
  arguments.talk.say_scene(scene);
  if (arguments.folder) {
    require_folder_name(*arguments.folder);
    return show_run(arguments, scene, *arguments.folder, true, words);
  }
  const TemporaryFolder folder("keeler-run");
  return show_run(arguments, scene, folder.path(), false, words);
}

} // namespace

void add_view(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  const auto view_arguments = std::make_shared<ViewArguments>();
  CLI::App& command =
      *program.add_subcommand("view", "show a run while it goes on, or a run's folder, in 3-D in a browser");
  view_arguments->scene
      .add_to(command, "SCENE|DIR|FILE", "a scene to run, or the folder of a run or a snapshot to show")
      ->required();
  command
      .add_option("-o,--output", view_arguments->folder,
                  "of a scene: the folder for the results (default: a temporary one, removed at the end)")
      ->type_name("DIR");
  command
      .add_option("--from", view_arguments->from, "of a scene: start from the particles and the box of this snapshot")
      ->type_name("FILE");
  command.add_flag("--force", view_arguments->force, "of a scene: replace the run in the folder");
  command.add_flag("--resume", view_arguments->resume, "of a folder: continue its run");
  command.add_flag("--open", view_arguments->open, "open the page in a browser");
  command.add_option("--port", view_arguments->port, "port of the page (default: a free one)")
      ->transform(whole_number_between(1, max_port, "a port"));
  view_arguments->threads.add_to(command);
  view_arguments->talk.add_to(command);
  examples_of(command, {"keeler view a-ring-wakes", "keeler view scene.toml -o wakes --open",
                        "keeler view wakes --resume", "keeler view wakes/snap_000003.hdf"});
  command.callback([view_arguments, arguments, &action] {
    requests_from_signals(); // before signals are released
    action = [view_arguments, arguments] { return view(*view_arguments, arguments); };
  });
}

} // namespace keeler::cli
