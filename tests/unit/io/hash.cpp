#include <keeler/io/hash.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace hash_test {

using namespace keeler;
using namespace keeler::io;

TEST_CASE("the hash of nothing is XXH3's published one") {
  CHECK(Hash().hex() == "99aa06d3014798d86001c324468d497f"); // XXH3_128bits, length 0, seed 0
}

TEST_CASE("a hash depends on the bytes and not on how they were cut into pieces") {
  std::vector<double> values(1000);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = 1.0 / static_cast<double>(k + 1);
  Hash whole, pieces;
  whole.add_bytes(std::as_bytes(std::span(values)));
  for (const double value : values)
    pieces.add(value);
  CHECK(whole.hex() == pieces.hex());

  values[500] = -values[500];
  Hash changed;
  changed.add_bytes(std::as_bytes(std::span(values)));
  CHECK(changed.hex() != whole.hex());
}

TEST_CASE("texts are kept apart") {
  Hash a, b;
  a.add_text("ab"), a.add_text("c");
  b.add_text("a"), b.add_text("bc");
  CHECK(a.hex() != b.hex());
}

} // namespace hash_test
