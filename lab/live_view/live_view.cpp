#include "live_view.hpp"

#include "access.hpp"
#include "shared.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <thread>
#include <utility>

namespace keeler::live_view {
namespace {

constexpr double max_charge = 5e-3; // s per frame of the server's time: frames do not wait long for a look at the past
constexpr auto turn = std::chrono::milliseconds(20); // in which a waiting run looks whether it ends
constexpr std::size_t field_count = 6;

} // namespace

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
  if (!scale_) {
    scale_ = runs::RingScale{.mass = 0.0,
                             .orbital_frequency = scene.planet.orbital_frequency,
                             .shear = simulation.state().box.shear,
                             .driven = !scene.external_forces.empty(),
                             .attracts = scene.gravity.has_value()};
    for (const Body& body : simulation.state().particles.bodies)
      scale_->mass += body.mass;
  }
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
  readable_ = simulation;
  readable_scene_ = scene;
  stage_ = simulation ? Stage::idle : Stage::running;
  if (!simulation)
    return;
  version_.fetch_add(1, std::memory_order_relaxed);
  orbits_.store(simulation->orbits(), std::memory_order_relaxed);
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

void LiveView::offer(const Simulation& simulation, const Scene& scene) noexcept {
  shared_->offer(&simulation, &scene);
}

void LiveView::withdraw() noexcept {
  shared_->offer(nullptr, nullptr);
}

void LiveView::linger() const {
  shared_->linger();
}

} // namespace keeler::live_view
