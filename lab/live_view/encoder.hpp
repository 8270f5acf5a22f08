// Frames: the particles of one instant as the page draws them. Per particle eight bytes for its place and radius and
// one for its colour, in the order of memory; of many particles a part, the same ones in each frame.
//
// A frame is made in one pass over the particles, in the time that reading them takes: what it needs to know before,
// the box around all particles and the ends of the colour bar, it takes from the frame before. A particle outside that
// box makes it begin again.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>
#include <keeler/simulation/simulation.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace keeler::live_view {

inline constexpr std::size_t max_shown = 100'000; ///< of more particles, a frame has about this many, evenly by id

/// Never changes once it is made.
struct Frame {
  nlohmann::ordered_json about;            ///< count, units of the numbers, box, colour bar
  std::shared_ptr<const std::string> data; ///< x, y, z, radius in 16 bits per particle, then the colours in 8
};

/// The smallest and largest x, y, z, radius (m) and value of the colour field of some particles.
struct Extent {
  static constexpr float huge = std::numeric_limits<float>::max();

  std::array<float, 5> low = {huge, huge, huge, huge, huge}, high = {-huge, -huge, -huge, -huge, -huge};
};

/// Makes frames of one colour field. The colour bar follows the values slowly, so that it does not flicker.
class Encoder {
public:
  explicit Encoder(render::ColourField field) : field_(field) {}

  /// Encodes a state between two steps. Reads it only.
  Frame encode(const Simulation& simulation, const Scene& scene);
  /// Encodes a snapshot.
  Frame encode(const Patch& patch);

private:
  void choose(const std::vector<std::uint64_t>& ids);
  template<class Load> std::shared_ptr<const std::string> pack(const Load& load);
  template<class Load> Extent pack_once(const Load& load, std::string& data);
  template<class Load> void follow_values(const Load& load);
  void make_table();
  bool fits(const Extent& extent) const;
  void fit(const Extent& extent);
  std::shared_ptr<std::string> buffer(std::size_t size);
  bool whole_range() const;
  Frame frame_of(std::shared_ptr<const std::string> data, std::size_t total, const ShearingBox& box,
                 double orbits) const;

  render::ColourField field_;
  std::vector<std::uint32_t> chosen_;                   // indices of the particles to show
  Extent extent_;                                       // that the numbers of a frame can express
  bool has_range_ = false;                              // the colour bar is known
  render::ColourRange range_;                           // the colour bar
  std::array<std::uint8_t, 4096> table_{};              // the colours of equal parts of the bar
  std::array<std::shared_ptr<std::string>, 3> buffers_; // of the last frames, used again when no page has them
};

} // namespace keeler::live_view
