// The neighbours of particles that are hit again and again in one step, as a moonlet is: their straight lines about the
// epoch, relative to the path that the particle had when its crowd was gathered, in single precision. A heavy particle
// hardly leaves that path, so that its next search need not look around again; and a line that is good for one step
// only leaves few of them.
//
// Invariant: whoever may touch the particle in the rest of the step, as long as this is no more than `margin` off that
// path, has a line in the crowd, that of its present orbit.
#pragma once

#include "contact_loop.hpp"
#include "line_sweep.hpp"

#include <numeric>
#include <vector>

namespace keeler {

class Crowd {
public:
  /// Nobody is in it yet. The step must stay where it is.
  void begin(const StepAtHand& step, std::uint32_t centre);
  std::uint32_t centre() const { return centre_; }
  double margin() const { return margin_; } ///< m
  /// What the centre's elements have changed by since.
  Elements change() const { return step_->particles->bodies[centre_].elements - then_.elements; }
  /// Somebody that may touch the centre, or that was hit.
  void take(std::uint32_t place);

  /// Calls visit(place) for everybody that the centre may touch between two times of the step. The buffer is scratch.
  template<class Visit>
  void visit(double begin, double end, std::vector<std::uint32_t>& buffer, const Visit& visit) const {
    if (buffer.size() < lines_.size() + sweep_padding)
      buffer.resize(lines_.size() + sweep_padding);
    std::iota(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(lines_.size()), 0);
    const std::size_t count = sweep_(middle_, lines_.data(), frame_, span(begin, end), buffer.data(), lines_.size());
    for (std::size_t k = 0; k < count; ++k)
      visit(lines_[buffer[k]].place);
  }

  std::size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
  LineSpan span(double begin, double end) const {
    const double rounding = 1e-6 * half_step_;
    return {static_cast<float>(begin - rounding), static_cast<float>(end + rounding)};
  }

  const StepAtHand* step_ = nullptr;
  std::uint32_t centre_ = 0;
  Body then_; // the centre when this began
  double half_step_ = 0.0, margin_ = 0.0;
  LineFrame frame_{};
  LineSweep sweep_ = line_sweeps(choose_instruction_set()).one;
  Line middle_; // the centre's: zero, sizes are all in the others
  std::vector<Line> lines_;
};

/// Those of one step, by their centres.
class Crowds {
public:
  void begin_step() { count_ = 0; }
  Crowd* of(std::uint32_t centre);
  /// An empty one, unless there are enough.
  Crowd* add(const StepAtHand& step, std::uint32_t centre);
  void drop(const Crowd* crowd);
  /// A particle has a new orbit.
  void changed(std::uint32_t place) {
    for (std::size_t k = 0; k < count_; ++k)
      if (crowds_[k].centre() != place)
        crowds_[k].take(place);
  }
  std::size_t bytes() const;

private:
  static constexpr std::size_t most = 8;
  std::size_t count_ = 0;
  std::vector<Crowd> crowds_;
};

} // namespace keeler
