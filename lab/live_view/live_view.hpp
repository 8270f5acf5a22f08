// A run, shown while it goes on: a page for browsers of this machine, with the particles in three dimensions, plots of
// the series, the snapshots so far, and buttons to pause, step and stop. docs/dev/view.md.
//
// Two threads meet here: the one that computes, which calls the members below between two steps, and the server's,
// which answers the pages. Nothing is computed for a page that does not ask.
#pragma once

#include <keeler/simulation/simulation.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace keeler::live_view {

enum class Stage {
  files,    ///< no run in this process: snapshots, and the series of their run
  starting, ///< the initial state is being made
  running,
  idle, ///< in memory, between two calls that compute
  finished,
  stopped
};

struct ViewOptions {
  std::string title;
  std::filesystem::path path; ///< a run's folder, or a snapshot; empty: only what is in memory
  int port = 0;               ///< 0: the system chooses
  std::function<void()> stop; ///< asks the run to stop; called in the server's thread. Empty: there is no run
  Stage stage = Stage::files;
};

class LiveView {
public:
  /// Serves the page from now on. Throws Error when no port can be had or the program has no server.
  explicit LiveView(const ViewOptions& options);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Precondition: is_open().
  std::string address() const;
  bool is_open() const;
  /// Ends the page, for any thread but the server's; a run that it has paused goes on. Also at destruction.
  void close();

  /// Changes what the page says about the run.
  void set_stage(Stage stage, const std::string& message);

  /// Call it between two steps, where kicks meet. Makes a frame if a page waits for one, and leaves it
  /// if there is no memory for it. Only reads. Throws Interrupted at the request of an Interruptible.
  void at_boundary(const Simulation& simulation, const Scene& scene);
  /// Returns true if a page wants the run to wait before its next step.
  bool holds() const;
  /// Waits while holds(), until `ends` returns true. Returns true if the next step may be done, which a page may have
  /// allowed for one step alone.
  bool wait(const Simulation& simulation, const Scene& scene, const std::function<bool()>& ends);

  /// Lets the server read this state until withdraw(), which waits until it does not. Both must outlive that.
  void offer(const Simulation& simulation, const Scene& scene) noexcept;
  void withdraw() noexcept;

  /// Waits until a page has got what set_stage() said, or a second has passed without one.
  void linger() const;

private:
  class Shared;
  std::unique_ptr<Shared> shared_;
};

} // namespace keeler::live_view
