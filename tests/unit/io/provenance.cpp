#include <keeler/io/provenance.hpp>

#include <keeler/core/version.hpp>

#include <doctest/doctest.h>

namespace provenance_test {

using namespace keeler;
using namespace keeler::io;

TEST_CASE("provenance has the program, the machine and the command line") {
  const Provenance provenance = collect_provenance({"keeler", "run", "my scene.toml", "--set", "title=it's"});
  for (const char* name :
       {"version", "commit", "compiler", "flags", "libraries", "host", "threads", "arguments", "started"}) {
    CAPTURE(name);
    REQUIRE(provenance.contains(name));
    CHECK_FALSE(provenance.at(name).empty());
  }
  CHECK(provenance.at("version") == program_version());
  CHECK(provenance.at("arguments") == "keeler run 'my scene.toml' --set 'title=it'\\''s'");
  CHECK(provenance.at("libraries").find("HDF5 1.") != std::string::npos);
  CHECK(provenance.at("started").size() == 20); // 2025-01-31T12:00:00Z
}

} // namespace provenance_test
