#include "snapshot_header.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::io {
namespace {

class Header {
public:
  explicit Header(const hdf5::Handle& root) : group_(hdf5::open_group(root, "Header")) {}

  /// Throws unless the attribute is `expected` within 1e-6, or missing. An expected value that is not finite is
  /// rejected later, by require_possible_frame().
  void require(const char* name, double expected, const char* why) const {
    if (!hdf5::has_attribute(group_, name) || !std::isfinite(expected))
      return;
    const auto value = hdf5::read_attribute<double>(group_, name);
    if (!(std::fabs(value - expected) <= 1e-6 * std::fabs(expected)))
      throw IoError(fmt::format("its /Header has {} {:g}, not {:g} ({})", name, value, expected, why));
  }

  /// Throws unless an attribute with one entry per GADGET particle type has `expected` for type 1 and 0 for the others.
  void require_type_1(const char* name, double expected, const char* why) const {
    if (!hdf5::has_attribute(group_, name) || !std::isfinite(expected))
      return;
    const auto values = hdf5::read_attribute_values<double>(group_, name);
    for (std::size_t type = 0; type < values.size(); ++type)
      if (const double wanted = type == 1 ? expected : 0.0; values[type] != wanted)
        throw IoError(
            fmt::format("its /Header has {} {:g} for type {}, not {:g} ({})", name, values[type], type, wanted, why));
  }

private:
  hdf5::Handle group_;
};

constexpr double high_word = 4294967296.0; // NumPart_Total_HighWord counts in 2³²

} // namespace

void require_header_fits(const hdf5::Handle& root, const Patch& patch, std::size_t count) {
  if (!hdf5::exists(root, "Header"))
    return;
  const Header header(root);
  header.require("NumFilesPerSnapshot", 1.0, "a start is one whole file; join the files into one");
  const double of_all = static_cast<double>(count), high = std::floor(of_all / high_word);
  constexpr char counts[] = "the length of the arrays in /PartType1; join or correct the file";
  header.require_type_1("NumPart_ThisFile", of_all, counts);
  header.require_type_1("NumPart_Total", of_all - high * high_word, counts);
  header.require_type_1("NumPart_Total_HighWord", high, counts);
  header.require_type_1("MassTable", 0.0, "masses are listed in /PartType1/Masses; set it to 0");
  header.require("BoxSize", std::max(patch.box.size_x, patch.box.size_y),
                 "the longer of L_x and L_y of /RingBox, m; correct one of them");
  const hdf5::Handle ring = hdf5::open_group(root, "RingBox");
  if (hdf5::has_attribute(ring, "time_s"))
    header.require("Time", hdf5::read_attribute<double>(ring, "time_s"), "time_s of /RingBox; correct one of them");
}

} // namespace keeler::io
