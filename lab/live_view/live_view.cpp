#include "live_view.hpp"

#include "access.hpp"
#include "encoder.hpp"
#include "page.hpp"
#include "page_server.hpp"
#include "past.hpp"
#include "series_feed.hpp"
#include "throttle.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/render/colour_field.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

namespace keeler::live_view {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
using render::ColourField;

// Limits the part of the run's processor time that frames and the server take.
constexpr double frame_interval = 0.045, fraction_of_frames = 0.015;
constexpr double max_charge = 5e-3; // s per frame of the server's time: frames do not wait long for a look at the past
constexpr auto turn = std::chrono::milliseconds(20); // in which a waiting run looks whether it ends
constexpr double max_limit = 1e4;                    // steps per second
constexpr std::size_t field_count = 6;

const char* name_of(Stage stage) {
  switch (stage) {
  case Stage::files:
    return "files";
  case Stage::starting:
    return "starting";
  case Stage::running:
    return "running";
  case Stage::idle:
    return "idle";
  case Stage::finished:
    return "finished";
  case Stage::stopped:
    return "stopped";
  }
  return "";
}

// Returns a value of a request, if it is a number.
template<class Number> std::optional<Number> number_in(const Request& request, const char* key) {
  const auto found = request.query.find(key);
  if (found == request.query.end())
    return std::nullopt;
  Number value{};
  const char *const begin = found->second.data(), *const end = begin + found->second.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

std::optional<ColourField> field_in(const Request& request) {
  const auto found = request.query.find("colour");
  const std::vector<std::string> names = render::colour_field_names();
  for (std::size_t k = 0; found != request.query.end() && k < names.size(); ++k)
    if (names[k] == found->second)
      return static_cast<ColourField>(k);
  return std::nullopt;
}

// Returns JSON as a page reads it before the bytes of a frame: its length in four bytes, then the text, with blanks so
// that the bytes begin at a multiple of eight.
std::string head_of(const Json& json) {
  std::string text = json_text(json);
  while ((text.size() + 4) % 8 != 0)
    text += ' ';
  std::string head;
  for (int k = 0; k < 4; ++k)
    head += static_cast<char>((text.size() >> (8 * k)) & 0xFFU);
  return head + text;
}

Reply json_reply(const Json& json) {
  return {.type = "application/json", .head = json_text(json), .body = {}, .content_policy = {}};
}

} // namespace

// What both threads see, under guard_, and what the server's thread alone has.
class LiveView::Shared {
public:
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
  Stage stage_;
  std::string message_;
  std::vector<Slot> slots_;
  Throttle frames_{frame_interval, fraction_of_frames};
  double charged_ = 0.0; // of server_seconds_
  std::uint64_t last_number_ = 0;
  bool rough_ = false; // the particles have spins
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

LiveView::Shared::Shared(const ViewOptions& options)
    : options_(options), stage_(options.stage),
      series_(std::filesystem::is_regular_file(options.path) ? std::filesystem::path() : options.path),
      past_(options.path) {
  for (std::size_t k = 0; k < field_count; ++k)
    slots_.emplace_back(static_cast<ColourField>(k));
  assert(render::colour_field_names().size() == field_count);
  page_ = make_page(options.title, random_token());
  server_.emplace([this](const Request& request) { return answer(request); }, options.port);
}

void LiveView::Shared::close() {
  if (!is_own_process())
    return;
  server_.reset();
  const std::lock_guard lock(guard_);
  for (Slot& slot : slots_)
    slot.wanted = false;
  paused_ = rows_wanted_ = false;
  limit_ = 0.0;
  note_attention();
  changed_.notify_all();
}

void LiveView::Shared::set_stage(Stage stage, const std::string& message) {
  const std::lock_guard lock(guard_);
  stage_ = stage;
  message_ = message;
  told_ = false;
}

void LiveView::Shared::linger() const {
  constexpr int turns = 20;
  for (int k = 0; k < turns; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::lock_guard lock(guard_);
    if (told_)
      break;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100)); // until it is sent
}

void LiveView::Shared::note_attention() {
  bool wanted = false;
  for (const Slot& slot : slots_)
    wanted = wanted || slot.wanted;
  attention_ = wanted || paused_ || limit_ > 0.0 || (rows_wanted_ && series_.is_sampled());
}

// Makes the frames that pages wait for. Precondition: the caller holds the guard, and the state may be read.
void LiveView::Shared::make_frames(const Simulation& simulation, const Scene& scene) {
  rough_ = simulation.state().particles.rough;
  const std::uint64_t version = version_;
  for (Slot& slot : slots_)
    if (slot.wanted && slot.version != version) {
      slot.frame = slot.encoder.encode(simulation, scene);
      slot.number = ++last_number_;
      slot.version = version;
      slot.wanted = false;
    }
}

void LiveView::Shared::at_boundary(const Simulation& simulation, const Scene& scene) {
  version_.fetch_add(1, std::memory_order_relaxed);
  orbits_.store(simulation.orbits(), std::memory_order_relaxed);
  if (!attention_.load(std::memory_order_relaxed) || !is_own_process())
    return;
  const std::lock_guard lock(guard_);
  if (frames_.due()) {
    const double served = server_seconds_.load(std::memory_order_relaxed);
    frames_.spend([&] { make_frames(simulation, scene); },
                  std::min(served - std::exchange(charged_, served), max_charge), threads());
  }
  if (rows_wanted_ && series_.is_sampled() && series_.sample_due()) {
    series_.sample(simulation, scene);
    rows_wanted_ = false;
  }
  note_attention();
}

bool LiveView::Shared::must_wait() const {
  if (paused_)
    return granted_ == 0;
  return limit_ > 0.0 && Clock::now() < last_step_ + std::chrono::duration<double>(1.0 / limit_);
}

bool LiveView::Shared::holds() const {
  if (!attention_.load(std::memory_order_relaxed) || !is_own_process())
    return false;
  const std::lock_guard lock(guard_);
  return must_wait();
}

bool LiveView::Shared::wait(const Simulation& simulation, const Scene& scene, const std::function<bool()>& ends) {
  if (!attention_.load(std::memory_order_relaxed) || !is_own_process())
    return true;
  std::unique_lock lock(guard_);
  bool is_over = ends();
  while (must_wait() && !is_over) {
    readable_ = &simulation;
    readable_scene_ = &scene;
    changed_.wait_for(lock, turn);
    is_over = ends();
  }
  readable_ = nullptr;
  if (is_over)
    return false;
  if (paused_)
    --granted_;
  last_step_ = Clock::now();
  return true;
}

void LiveView::Shared::offer(const Simulation* simulation, const Scene* scene) {
  if (!is_own_process())
    return;
  const std::lock_guard lock(guard_);
  if (simulation) {
    version_.fetch_add(1, std::memory_order_relaxed);
    orbits_.store(simulation->orbits(), std::memory_order_relaxed);
    if (rows_wanted_ && series_.is_sampled())
      series_.sample(*simulation, *scene);
  }
  readable_ = simulation;
  readable_scene_ = scene;
  stage_ = simulation ? Stage::idle : Stage::running;
}

// --- the server's thread

// The folder's snapshots. Without a library that is safe for threads, only when no run of this process writes some.
const std::vector<std::string>& LiveView::Shared::past_names() {
  static const std::vector<std::string> none;
  return has_state() && !past_is_safe_ ? none : past_.names();
}

Json LiveView::Shared::state() {
  const std::vector<std::string>& names = past_names();
  const std::lock_guard lock(guard_);
  told_ = true;
  std::vector<std::string> fields = render::colour_field_names();
  if (!rough_)
    std::erase(fields, "spin");
  return {{"stage", name_of(stage_)}, {"message", message_}, {"orbits", orbits_.load(std::memory_order_relaxed)},
          {"paused", paused_},        {"limit", limit_},     {"control", options_.stop && has_state()},
          {"snapshots", names},       {"fields", fields}};
}

Reply LiveView::Shared::reply_with(const Frame* frame, std::uint64_t number) {
  Json head = state();
  Reply reply{.type = "application/octet-stream", .head = {}, .body = {}, .content_policy = {}};
  if (frame) {
    head["number"] = number;
    head["frame"] = frame->about;
    reply.body = frame->data;
  }
  reply.head = head_of(head);
  return reply;
}

// Returns the newest frame of a field, or none if the page has that already.
Reply LiveView::Shared::frame(const Request& request) {
  const ColourField field = field_in(request).value_or(ColourField::height);
  const std::uint64_t have = number_in<std::uint64_t>(request, "have").value_or(0);
  std::optional<Frame> frame;
  std::uint64_t number = 0;
  bool in_memory = false;
  {
    const std::lock_guard lock(guard_);
    in_memory = has_state() || stage_ == Stage::stopped;
    if (in_memory) {
      Slot& slot = slots_[static_cast<std::size_t>(field)];
      slot.wanted = true; // also if there is one: it is made while the page gets that
      if (slot.version != version_ && readable_)
        make_frames(*readable_, *readable_scene_);
      if (slot.frame && slot.number != have) {
        frame = slot.frame;
        number = slot.number;
      }
      note_attention();
    }
  }
  if (in_memory)
    return reply_with(frame ? &*frame : nullptr, number);
  const std::size_t count = past_names().size();
  std::optional<Reply> newest = count > 0 ? past_frame(count - 1, field, have) : std::nullopt;
  return newest ? std::move(*newest) : reply_with(nullptr, 0);
}

std::optional<Reply> LiveView::Shared::past_frame(std::size_t k, ColourField field, std::uint64_t have) {
  const std::string name = past_names()[k];
  if (!past_frame_ || past_frame_->name != name || past_frame_->field != field) {
    PastFrame next{name, field, past_.frame(k, field), 0};
    const std::lock_guard lock(guard_);
    next.number = ++last_number_;
    rough_ = past_.has_spins();
    past_frame_ = std::move(next);
  }
  if (past_frame_->number == have)
    return std::nullopt;
  return reply_with(&past_frame_->frame, past_frame_->number);
}

Reply LiveView::Shared::past(const Request& request) {
  const std::size_t count = past_names().size();
  const std::optional<std::size_t> k = number_in<std::size_t>(request, "k");
  if (!k || *k >= count)
    throw UsageError("there is no such snapshot");
  return *past_frame(*k, field_in(request).value_or(ColourField::height), 0);
}

// Rows of a folder belong to this thread alone; sampled ones come from the thread that computes.
Reply LiveView::Shared::plots() {
  std::unique_lock lock(guard_);
  if (series_.is_sampled()) {
    rows_wanted_ = true;
    if (readable_ && series_.sample_due())
      series_.sample(*readable_, *readable_scene_);
    note_attention();
  } else if (!has_state() || past_is_safe_) {
    lock.unlock();
    series_.refresh(past_);
  }
  return {.type = "application/json", .head = {}, .body = series_.text(), .content_policy = {}};
}

std::optional<Reply> LiveView::Shared::command(const Request& request) {
  if (!options_.stop)
    return std::nullopt;
  {
    const std::lock_guard lock(guard_);
    if (request.path == "pause")
      paused_ = true;
    else if (request.path == "resume")
      paused_ = false, granted_ = 0;
    else if (request.path == "step")
      paused_ = true, ++granted_;
    else if (request.path == "limit") {
      const double limit = number_in<double>(request, "steps_per_second").value_or(0.0);
      limit_ = limit > 0.0 && limit <= max_limit ? limit : 0.0;
    } else if (request.path != "stop")
      return std::nullopt;
    note_attention();
  }
  changed_.notify_all();
  if (request.path == "stop")
    options_.stop();
  return json_reply(state());
}

std::optional<Reply> LiveView::Shared::answer(const Request& request) {
  server_seconds_.store(thread_seconds(), std::memory_order_relaxed);
  if (request.is_command)
    return command(request);
  if (request.path.empty())
    return Reply{.type = "text/html; charset=utf-8", .head = page_.html, .body = {}, .content_policy = page_.policy};
  if (request.path == "state")
    return json_reply(state());
  if (request.path == "frame")
    return frame(request);
  if (request.path == "past")
    return past(request);
  if (request.path == "plots")
    return plots();
  return std::nullopt;
}

// --- the view

LiveView::LiveView(const ViewOptions& options) : shared_(std::make_unique<Shared>(options)) {}

LiveView::~LiveView() {
  if (!shared_->is_own_process())
    static_cast<void>(shared_.release()); // a fork has no server's thread, and may have its locks
}

std::string LiveView::address() const {
  return shared_->address();
}

bool LiveView::is_open() const {
  return shared_->is_open();
}

void LiveView::close() {
  shared_->close();
}

void LiveView::set_stage(Stage stage, const std::string& message) {
  shared_->set_stage(stage, message);
}

void LiveView::at_boundary(const Simulation& simulation, const Scene& scene) {
  try {
    shared_->at_boundary(simulation, scene);
  } catch (const Interrupted&) {
    throw;
  } catch (...) { // a run does not end because it is watched
  }
}

bool LiveView::holds() const {
  return shared_->holds();
}

bool LiveView::wait(const Simulation& simulation, const Scene& scene, const std::function<bool()>& ends) {
  return shared_->wait(simulation, scene, ends);
}

void LiveView::offer(const Simulation& simulation, const Scene& scene) {
  shared_->offer(&simulation, &scene);
}

void LiveView::withdraw() {
  shared_->offer(nullptr, nullptr);
}

void LiveView::linger() const {
  shared_->linger();
}

} // namespace keeler::live_view
