#include <keeler/comm/same_request.hpp>

#include <fmt/format.h>

#include <cassert>
#include <map>
#include <optional>

namespace keeler::comm {
namespace {

using Values = std::map<std::string, std::string>;

// Packs the request into one text. Names and values end with a zero byte, which neither an argument nor a path can
// contain.
std::string packed(const std::vector<RequestEntry>& request) {
  std::string text;
  for (const RequestEntry& entry : request)
    for (const std::string& part : {entry.name, entry.value}) {
      assert(part.find('\0') == std::string::npos);
      text += part + '\0';
    }
  return text;
}

Values unpacked(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == '\0')
      parts.emplace_back();
    else
      parts.back() += c;
  Values values;
  for (std::size_t k = 0; k + 1 < parts.size(); k += 2)
    values[parts[k]] = parts[k + 1];
  return values;
}

std::string describe(const std::string& name, const std::optional<std::string>& value) {
  constexpr std::size_t max_length = 100; // a table of radii may have a megabyte
  if (!value)
    return "no " + name;
  return value->size() > max_length ? fmt::format("{} = {} ...", name, value->substr(0, max_length))
                                    : fmt::format("{} = {}", name, *value);
}

std::optional<std::string> value_in(const Values& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

// Returns the first name with different values: in the order of the request, then among names that only the root has.
std::optional<std::string> difference(const std::vector<RequestEntry>& request, const Values& own,
                                      const Values& of_root) {
  for (const RequestEntry& entry : request)
    if (value_in(of_root, entry.name) != entry.value)
      return entry.name;
  for (const auto& [name, value] : of_root)
    if (!own.contains(name))
      return name;
  return std::nullopt;
}

} // namespace

void require_same_request(const std::vector<RequestEntry>& request, const Communicator& ranks) {
  if (!ranks.distributed())
    return;
  std::string text = packed(request);
  ranks.broadcast(text);
  ranks.together([&] {
    const Values of_root = unpacked(text), own = unpacked(packed(request));
    if (const std::optional<std::string> name = difference(request, own, of_root))
      throw UsageError(
          fmt::format("the request of rank {} differs from that of rank 0: it has {}, and rank 0 has {}; start all "
                      "ranks with the same command and the same files",
                      ranks.rank(), describe(*name, value_in(own, *name)), describe(*name, value_in(of_root, *name))));
  });
}

} // namespace keeler::comm
