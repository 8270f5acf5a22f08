#include <keeler/light/scattering.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/suggest.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>

namespace keeler::light {
namespace {

constexpr LawEntry entries[] = {
    {"callisto", "", 0, 0, 0, "the power law of Callisto, n = 3.092 (Dones, Cuzzi & Showalter 1993)",
     [](double, double albedo) { return power_law(3.092, albedo); }},
    {"power_law", "n", 3.092, -1e-9, 100, "P ~ (pi - alpha)^n (Dones, Cuzzi & Showalter 1993)",
     [](double n, double albedo) { return power_law(std::fmax(0.0, n), albedo); }},
    {"henyey_greenstein", "g", 0, -0.99, 0.99,
     "P of Henyey & Greenstein (1941) with the mean cosine g of the scattering angle; below 0 light goes back",
     henyey_greenstein_law},
    {"isotropic", "", 0, 0, 0, "P = 1", [](double, double albedo) { return isotropic_law(albedo); }},
    {"lambert", "", 0, 0, 0, "each point of a sphere is a Lambert surface",
     [](double, double albedo) { return lambert_law(albedo); }},
    {"lommel_seeliger", "", 0, 0, 0, "each point of a sphere is a surface after Lommel and Seeliger",
     [](double, double albedo) { return lommel_seeliger_law(albedo); }},
};

struct LawsOfProgram {
  std::mutex guard;
  std::map<std::string, SharedLaw (*)(double)> laws;
};

LawsOfProgram& laws_of_program() {
  static LawsOfProgram laws;
  return laws;
}

double parameter_of(const LawEntry& entry, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > entry.low && value < entry.high))
    throw UsageError(fmt::format("'{}' is not the {} of the law {}; give a number from {} to {}", text, entry.parameter,
                                 entry.name, format_number(entry.low + 1e-9, 3), format_number(entry.high, 3)));
  return value;
}

} // namespace

std::span<const LawEntry> law_entries() {
  return entries;
}

SharedLaw law_named(const std::string& text, double albedo) {
  if (!(albedo > 0.0 && albedo <= 1.0))
    throw UsageError(fmt::format("the albedo {:g} is not above 0 and up to 1; correct it", albedo));
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  std::vector<std::string> names;
  for (const LawEntry& entry : entries) {
    if (name == entry.name) {
      if (equals == std::string::npos)
        return entry.make(entry.fallback, albedo);
      if (*entry.parameter == '\0')
        throw UsageError(fmt::format("the law {} has no parameter; leave '{}' out", name, text.substr(equals)));
      return entry.make(parameter_of(entry, text.substr(equals + 1)), albedo);
    }
    names.emplace_back(entry.name);
  }
  LawsOfProgram& own = laws_of_program();
  const std::lock_guard lock(own.guard);
  if (const auto found = own.laws.find(text); found != own.laws.end())
    return found->second(albedo);
  for (const auto& law : own.laws)
    names.push_back(law.first);
  const std::string near = closest(name, names);
  throw UsageError(fmt::format("there is no scattering law '{}'{}; the laws are {}", name,
                               near.empty() ? "" : ", did you mean '" + near + "'?", fmt::join(names, ", ")));
}

void add_law(const std::string& name, SharedLaw (*make)(double albedo)) {
  if (name.empty() || name.find('=') != std::string::npos)
    throw UsageError("a scattering law needs a name without '='; give it one");
  for (const LawEntry& entry : entries)
    if (name == entry.name)
      throw UsageError(fmt::format("there is a scattering law '{}' already; give this one another name", name));
  LawsOfProgram& own = laws_of_program();
  const std::lock_guard lock(own.guard);
  if (!own.laws.try_emplace(name, make).second)
    throw UsageError(fmt::format("there is a scattering law '{}' already; give this one another name", name));
}

} // namespace keeler::light
