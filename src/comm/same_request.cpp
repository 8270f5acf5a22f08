#include <keeler/comm/same_request.hpp>

#include <fmt/format.h>

#include <map>
#include <optional>

namespace keeler {
namespace {

using Values = std::map<std::string, std::string>;

// Names and values end with a byte that neither an argument nor a file's path can hold.
std::string packed(const std::vector<Asked>& request) {
  std::string text;
  for (const Asked& asked : request)
    for (const std::string& part : {asked.name, asked.value})
      text += part + '\0';
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

std::string in_words(const std::string& name, const std::optional<std::string>& value) {
  constexpr std::size_t longest = 100; // a table of radii may be a megabyte
  if (!value)
    return "no " + name;
  return value->size() > longest ? fmt::format("{} = {} ...", name, value->substr(0, longest))
                                 : fmt::format("{} = {}", name, *value);
}

std::optional<std::string> value_in(const Values& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

// The first name, in the order of the request, then of what the first rank alone has, that has another value there.
std::optional<std::string> difference(const std::vector<Asked>& request, const Values& own, const Values& first) {
  for (const Asked& asked : request)
    if (value_in(first, asked.name) != asked.value)
      return asked.name;
  for (const auto& [name, value] : first)
    if (!own.contains(name))
      return name;
  return std::nullopt;
}

} // namespace

void require_same_request(const std::vector<Asked>& request, const Communicator& ranks) {
  if (!ranks.distributed())
    return;
  std::string text = packed(request);
  ranks.broadcast(text);
  ranks.together([&] {
    const Values first = unpacked(text), own = unpacked(packed(request));
    if (const std::optional<std::string> name = difference(request, own, first))
      throw UsageError(
          fmt::format("rank {} is asked for something else than rank 0: it has {}, and rank 0 has {}; start "
                      "all ranks with the same command and the same files",
                      ranks.rank(), in_words(*name, value_in(own, *name)), in_words(*name, value_in(first, *name))));
  });
}

} // namespace keeler
