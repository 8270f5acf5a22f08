// Frames: the particles of one instant as the page draws them. Per particle eight bytes for its place and radius and
// one for its colour, in the order of memory; of many particles a part, the same ones in each frame.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/render/colour_field.hpp>
#include <keeler/simulation/simulation.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace keeler::live_view {

inline constexpr std::size_t max_shown = 100'000; ///< of more particles, a frame has about this many, evenly by id

/// Never changes once it is made.
struct Frame {
  nlohmann::ordered_json about;            ///< count, units of the numbers, box, colour bar
  std::shared_ptr<const std::string> data; ///< x, y, z, radius in 16 bits per particle, then the colours in 8
  double orbits = 0.0;
  std::int64_t step = -1; ///< -1: of a snapshot
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
  struct Columns { // one number per shown particle
    std::array<std::vector<float>, 3> places;
    std::vector<float> radii, values;
    void resize(std::size_t count);
  };

  void fill(const Simulation& simulation, const Scene& scene);
  void fill(const Patch& patch);
  Frame pack(std::size_t total, const ShearingBox& box, double orbits);
  render::ColourRange next_range();
  void pack_colours(const render::ColourRange& range, std::uint8_t* bytes) const;

  render::ColourField field_;
  Columns columns_; // kept between frames
  std::vector<std::uint32_t> chosen_;
  std::vector<std::uint16_t> packed_;
  bool has_range_ = false;
  render::ColourRange range_;
};

} // namespace keeler::live_view
