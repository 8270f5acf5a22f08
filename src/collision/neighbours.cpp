#include "neighbours.hpp"

#include <algorithm>

namespace keeler {
namespace {

constexpr double most_steps = 16.0;    // of a window
constexpr double longest_window = 1.0; // rad: bounds and rounding are good for that long
constexpr double window_hits = 0.3;    // of a particle in a window: more, and lists are remade too often
constexpr double window_skin = 0.2;    // of a mean radius
constexpr double farthest_stray = 2.0; // of lines from their cells before a window ends

} // namespace

Image Neighbours::nearest_image(const Body& a, const Body& b) const {
  const Elements el = b.elements - a.elements;
  const double x = el.guiding_x - el.e_cos, y = el.guiding_y + (2.0 / frequencies_.kappa) * el.e_sin;
  return box_.image_into_cell(x, y, offset_);
}

bool Neighbours::begin(const Particles& particles, const ShearingBox& box, double offset) {
  const bool same = particles_ == &particles && changed_.size() == particles.size();
  particles_ = &particles;
  box_ = box;
  offset_ = offset;
  ++at_step_;
  if (!(goes_on_ && !over_ && same && at_step_ < length_ && kick_path_ <= skin_))
    open();
  goes_on_ = false;
  for (Looks& looks : looks_)
    looks.too_many = false;
  const double half = 0.5 * step_;
  to_middle_ = Rotation(frequencies_, -since_middle());
  step_test_ = {frequencies_, half, half, 1e-13 * (box_.size_x + box_.size_y)};
  return mirror_.one_image();
}

// The path of a kicked particle departs from its old one by at most |Δv| (t + t²) in a time t < 1.
void Neighbours::kicked(double largest) {
  const double time = length_ * step_;
  last_kick_ = largest;
  kick_path_ += largest * time * (1.0 + time);
}

// What two kicks a step, a third larger than the last one, may add up to.
double Neighbours::skin_for(int length) const {
  const double time = length * step_;
  return 2.6 * last_kick_ * length * time * (1.0 + time);
}

// The length that costs least by what the last window came to: a mirror is made once a window and the pairs tested grow
// with the square of what particles reach, the lists with the window. Costs are in units of testing a pair.
double Neighbours::cost_of(int length) const {
  constexpr double mirror = 14.0, listed_pair = 2.0; // a particle; a pair and step
  const MirrorMeans& means = mirror_.means();
  const auto reach = [&](int steps) { return means.radius + 0.5 * steps * step_ * means.eccentricity; };
  const double growth = reach(length) / reach(length_);
  const double pairs = last_tested_ * growth * growth, list = last_listed_ * length / length_;
  return (mirror + pairs) / length + listed_pair * list;
}

void Neighbours::choose_length() {
  const int last = length_;
  const double steps_done = std::max(1, at_step_) * static_cast<double>(std::max<std::size_t>(1, changed_.size()));
  const double hits = static_cast<double>(hits_) / steps_done; // of a particle in a step of the last window
  int best = 1;
  if (windows > 0 && last > 0 && particles_->size() > 0)
    for (int length = 2; length <= most_steps && length * step_ <= longest_window; ++length)
      if (length * hits <= window_hits && skin_for(length) <= window_skin * mirror_.means().radius &&
          cost_of(length) < cost_of(best))
        best = length;
  length_ = best;
}

void Neighbours::open() {
  choose_length();
  over_ = false;
  at_step_ = 0;
  hits_ = 0;
  skin_ = length_ > 1 ? skin_for(length_) : 0.0;
  kick_path_ = 0.0;
  const auto build = [&] {
    mirror_.build(*particles_, box_, offset_, frequencies_, {-since_middle(), 0.5 * length_ * step_, skin_});
    ++windows;
  };
  build();
  if (!mirror_.one_image() && length_ > 1) { // one step may be short enough
    length_ = 1;
    skin_ = 0.0;
    build();
  }
  changed_.assign(particles_->size(), 0);
  list_pairs();
}

void Neighbours::use_lists(std::size_t count) {
  used_lists_ = count;
  if (lists_.size() < count)
    lists_.resize(count);
}

void Neighbours::list_pairs() {
  first_lists_ = mirror_.one_image() ? (mirror_.size() + block_size - 1) / block_size : 0;
  use_lists(first_lists_);
  std::vector<std::uint64_t> tests(first_lists_);
  const double half = 0.5 * length_ * step_;
  parallel_for(
      first_lists_,
      [&](std::size_t b) {
        std::vector<LinePair> buffer;
        std::vector<Entry>& list = lists_[b].entries;
        list.clear();
        lists_[b].made = 0;
        const std::size_t begin = b * block_size, end = std::min(mirror_.size(), begin + block_size);
        tests[b] = mirror_.sweep_pairs(begin, end, span(-half, half), buffer, [&](std::size_t i, std::size_t j) {
          list.push_back(entry(mirror_.place(i), mirror_.place(j)));
        });
      },
      1);
  std::uint64_t tests_now = 0, listed_now = 0;
  for (std::size_t b = 0; b < first_lists_; ++b) {
    tests_now += tests[b];
    listed_now += lists_[b].entries.size();
  }
  tested += tests_now;
  listed += listed_now;
  const double count = static_cast<double>(mirror_.size()) + 1e-9;
  last_tested_ = static_cast<double>(tests_now) / count;
  last_listed_ = static_cast<double>(listed_now) / count;
}

bool Neighbours::gather(std::size_t i, double start, std::vector<std::uint32_t>& buffer, Crowd& crowd) const {
  Line line = mirror_.line(i);
  line.size += static_cast<float>(1.001 * crowd.margin());
  if (!mirror_.one_image(line, mirror_.whole()))
    return false;
  const double now = since_middle();
  const std::size_t count = mirror_.near(mirror_.whole(), line, span(now + start, now + 0.5 * step_), buffer);
  if (count < fewest_in_crowd)
    return false;
  for (std::size_t k = 0; k < count; ++k)
    if (const std::uint32_t j = mirror_.place(buffer[k]); j != i)
      crowd.take(j);
  return true;
}

void Neighbours::set_lookers(std::size_t count) {
  if (looks_.size() < count)
    looks_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    looks_[k].made.clear();
    looks_[k].seen.assign(1, 0); // looks begin behind
  }
}

void Neighbours::changed(MirrorPart& part, std::size_t looker, std::size_t i) {
  if (looks_needed()) {
    Looks& looks = looks_[looker];
    looks.too_many |= looks.made.size() == most_looks;
    if (looks.too_many) // which ends the window
      looks.made.clear();
    mirror_.note(i) = static_cast<std::uint32_t>(looker * most_looks + looks.made.size());
    looks.made.emplace_back();
  }
  changed_[i] = static_cast<std::uint8_t>(at_step_ + 1);
  mirror_.replace(part, i, line_of(particles_->bodies[i]));
}

void Neighbours::restore(MirrorPart& part, std::size_t i, Mark mark) {
  changed_[i] = mark.changed;
  mirror_.note(i) = mark.look;
  mirror_.replace(part, i, line_of(particles_->bodies[i]));
}

void Neighbours::settle(std::span<const std::uint32_t> particles, std::uint64_t collisions,
                        const std::function<void()>& beside) {
  hits_ += 2 * collisions;
  over_ = mirror_.stray() > farthest_stray ||
          std::any_of(looks_.begin(), looks_.end(), [](const Looks& looks) { return looks.too_many; });
  constexpr std::size_t chunk = 128;
  const std::size_t before = used_lists_, more = over_ || !looks_needed() ? 0 : (particles.size() + chunk - 1) / chunk;
  use_lists(before + more);
  std::vector<std::uint8_t> too_fast(more);
  parallel_for(
      1 + more,
      [&](std::size_t k) {
        if (k == 0) {
          beside();
          return;
        }
        const std::size_t c = k - 1;
        lists_[before + c].made = static_cast<std::uint8_t>(at_step_ + 1);
        too_fast[c] = !relist(particles.subspan(c * chunk, std::min(chunk, particles.size() - c * chunk)),
                              lists_[before + c].entries);
      },
      1);
  over_ |= std::find(too_fast.begin(), too_fast.end(), 1) != too_fast.end();
}

// What particles that were hit may meet in the rest of the window. False: one is too fast for that, which ends it.
bool Neighbours::relist(std::span<const std::uint32_t> particles, std::vector<Entry>& list) {
  const LineSpan rest = span(since_middle() + 0.5 * step_, 0.5 * length_ * step_);
  const auto this_step = static_cast<std::uint8_t>(at_step_ + 1);
  std::vector<std::uint32_t> buffer;
  list.clear();
  for (const std::uint32_t i : particles) {
    if (!one_image(mirror_.whole(), i))
      return false;
    const auto keep = [&](std::uint32_t j) {
      if (j != i && (changed_[j] != this_step || lists(i, j)))
        list.push_back(entry(i, j));
    };
    if (const Look last = look(i); last.begin > 0) {
      const std::vector<std::uint32_t>& seen = looks_[mirror_.note(i) / most_looks].seen;
      std::for_each(seen.begin() + last.begin, seen.begin() + last.end, keep);
      continue;
    }
    const std::size_t count = mirror_.near(mirror_.whole(), mirror_.line(i), rest, buffer);
    for (std::size_t n = 0; n < count; ++n)
      keep(mirror_.place(buffer[n]));
  }
  return true;
}

void Neighbours::release() {
  forget();
  mirror_.release();
}

std::size_t Neighbours::bytes() const {
  std::size_t total = mirror_.bytes() + changed_.capacity();
  for (const Looks& looks : looks_)
    total += sizeof looks + looks.made.capacity() * sizeof(Look) + looks.seen.capacity() * sizeof(std::uint32_t);
  for (const List& list : lists_)
    total += list.entries.capacity() * sizeof(Entry) + sizeof list;
  return total;
}

} // namespace keeler
