#include <keeler/io/provenance.hpp>

#include "provenance_attributes.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/core/version.hpp>

#include <fmt/format.h>
#include <hdf5.h>
#include <xxhash.h>

#include <ctime>
#include <sys/utsname.h>

namespace keeler::io {
namespace {

std::string library_versions() {
  unsigned major = 0, minor = 0, patch = 0;
  H5get_libversion(&major, &minor, &patch);
  const unsigned xxhash = XXH_versionNumber();
  return fmt::format("HDF5 {}.{}.{}, Eigen {}.{}.{}, xxHash {}.{}.{}, fmt {}.{}.{}", major, minor, patch,
                     EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, xxhash / 10000, xxhash / 100 % 100,
                     xxhash % 100, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100);
}

std::string host() {
  utsname name = {};
  if (::uname(&name) != 0)
    return "unknown";
  return fmt::format("{} ({} {}, {})", name.nodename, name.sysname, name.release, name.machine);
}

// Joins the arguments to one line, quoted so that a shell can run it.
std::string command_line(const std::vector<std::string>& arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    const bool plain = !argument.empty() && argument.find_first_of(" \t\n\"'\\$&;|<>()*?[]#~`!{}") == std::string::npos;
    std::string quoted = argument;
    for (std::size_t at = quoted.find('\''); at != std::string::npos; at = quoted.find('\'', at + 4))
      quoted.replace(at, 1, "'\\''");
    line += (line.empty() ? "" : " ") + (plain ? argument : "'" + quoted + "'");
  }
  return line;
}

} // namespace

std::string utc_now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm utc = {};
  ::gmtime_r(&seconds, &utc);
  char text[32] = {};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

Provenance collect_provenance(const std::vector<std::string>& arguments) {
  return {{"version", program_version()},
          {"commit", source_commit()},
          {"compiler", build_compiler()},
          {"flags", build_flags()},
          {"libraries", library_versions()},
          {"host", host()},
          {"threads", std::to_string(threads())},
          {"arguments", command_line(arguments)},
          {"started", utc_now()}};
}

void write_provenance(const hdf5::Handle& object, const Provenance& provenance) {
  for (const auto& [name, value] : provenance)
    hdf5::write_attribute(object, name, value);
}

Provenance read_provenance(const hdf5::Handle& object) {
  Provenance provenance;
  for (const std::string& name : hdf5::attribute_names(object))
    if (hdf5::layout_of_attribute(object, name).type == "text")
      provenance[name] = hdf5::read_text_attribute(object, name);
  return provenance;
}

} // namespace keeler::io
