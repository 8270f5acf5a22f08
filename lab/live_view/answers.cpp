// The answers to pages, in the server's thread.
#include "shared.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>

#include <charconv>
#include <utility>

namespace keeler::live_view {
namespace {

using Json = nlohmann::ordered_json;
using render::ColourField;

constexpr double max_limit = 1e4; // steps per second

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
    std::optional<runs::RingScale> scale = scale_;
    const bool from_snapshots = !scale && !has_state();
    lock.unlock();
    if (from_snapshots)
      scale = past_.scale();
    series_.refresh(scale);
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

} // namespace keeler::live_view
