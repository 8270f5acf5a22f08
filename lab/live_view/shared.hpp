// The state of a view that both threads use: the one that computes (live_view.cpp) and the server's (answers.cpp).
#pragma once

#include "encoder.hpp"
#include "live_view.hpp"
#include "page.hpp"
#include "page_server.hpp"
#include "past.hpp"
#include "series_feed.hpp"
#include "throttle.hpp"

#include <keeler/render/colour_field.hpp>

#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <unistd.h>

namespace keeler::live_view {

class LiveView::Shared {
public:
  using Json = nlohmann::ordered_json;
  using Clock = std::chrono::steady_clock;
  using ColourField = render::ColourField;

  explicit Shared(const ViewOptions& options);

  std::string address() const { return server_->address(); }
  bool is_open() const { return server_.has_value() && is_own_process(); }
  void close();
  void set_stage(Stage stage, const std::string& message);
  void at_boundary(const Simulation& simulation, const Scene& scene);
  bool holds() const;
  bool wait(const Simulation& simulation, const Scene& scene, const std::function<bool()>& ends);
  void offer(const Simulation* simulation, const Scene* scene);
  void linger() const;
  bool is_own_process() const { return process_ == getpid(); }

private:
  // One colour field of the state in memory.
  struct Slot {
    explicit Slot(ColourField field) : encoder(field) {}
    Encoder encoder;
    std::optional<Frame> frame;
    std::uint64_t number = 0;  // of the frame, for pages
    std::uint64_t version = 0; // of the state in it
    bool wanted = false;
  };
  struct PastFrame {
    std::string name;
    ColourField field = ColourField::height;
    Frame frame;
    std::uint64_t number = 0;
  };

  std::optional<Reply> answer(const Request& request);
  Reply frame(const Request& request);
  Reply past(const Request& request);
  Reply plots();
  std::optional<Reply> command(const Request& request);
  std::optional<Reply> past_frame(std::size_t k, ColourField field, std::uint64_t have);
  Reply reply_with(const Frame* frame, std::uint64_t number);
  Json state();
  const std::vector<std::string>& past_names();
  bool has_state() const { return stage_ == Stage::running || stage_ == Stage::idle || stage_ == Stage::starting; }
  void make_frames(const Simulation& simulation, const Scene& scene);
  void note_attention();
  bool must_wait() const;

  const ViewOptions options_;
  const pid_t process_ = getpid();
  Page page_;

  mutable std::mutex guard_;
  std::condition_variable changed_;
  std::atomic<Stage> stage_; // changed under the guard
  std::string message_;
  std::vector<Slot> slots_;
  // Frames and the server take at most this part of the run's processor time.
  static constexpr double frame_interval = 0.045, fraction_of_frames = 0.015;
  Throttle frames_{frame_interval, fraction_of_frames, Throttle::Of::thread_time};
  double charged_ = 0.0; // of server_seconds_
  std::uint64_t last_number_ = 0;
  std::optional<runs::RingScale> scale_; // of the series of a run in this process
  bool rough_ = false;                   // the particles have spins
  bool paused_ = false;
  std::int64_t granted_ = 0; // steps that may be done while paused
  double limit_ = 0.0;       // steps per second; 0: none
  Clock::time_point last_step_ = Clock::now();
  const Simulation* readable_ = nullptr;
  const Scene* readable_scene_ = nullptr;
  SeriesFeed series_;
  bool rows_wanted_ = false;
  bool told_ = true; // a page knows the stage

  // without the guard, so that an unwatched run does not wait for it
  std::atomic<bool> attention_ = false;
  std::atomic<std::uint64_t> version_ = 1; // of the state in memory
  std::atomic<double> orbits_ = 0.0;
  std::atomic<double> server_seconds_ = 0.0; // processor time of the server's thread

  // of the server's thread
  Past past_;
  std::optional<PastFrame> past_frame_;
  bool past_is_safe_ = Past::is_safe_beside_a_run();

  std::optional<PageServer> server_; // last: its thread uses all others
};

} // namespace keeler::live_view
