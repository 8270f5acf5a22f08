#include "grid.hpp"

#include <keeler/config/document.hpp>
#include <keeler/core/error.hpp>
#include <keeler/files/input.hpp>
#include <keeler/files/toml_bounds.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace keeler::sweep {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

constexpr const char* seed_key = "particles.seed";

// Returns true if a text value of the key names a file.
bool names_file(const std::string& path) {
  const Key* const key = scene::find_key(path);
  return key && (key->type == KeyType::path || key->type == KeyType::rows);
}

class GridReader {
public:
  explicit GridReader(const fs::path& file) : text_(files::read_input(file, file.string())) {
    grid_.file = file;
    grid_.text = text_;
  }

  Grid read() {
    const toml::table table = parse();
    known(table, {"scene", "seeds", "since", "set", "axis", "plot"}, "a grid");
    read_scene(table);
    read_since(table);
    read_seeds(table);
    read_set(table);
    read_axes(table);
    read_plot(table);
    return std::move(grid_);
  }

private:
  toml::table parse() const {
    files::require_bounded_toml(text_, grid_.file.string());
    try {
      return toml::parse(text_, grid_.file.string());
    } catch (const toml::parse_error& error) {
      config::fail_at(position(error.source().begin), files::toml_fault(error.description()));
    }
  }

  std::string position(const toml::source_position& at) const {
    return fmt::format("{}:{}:{}", grid_.file.string(), at.line, at.column);
  }
  std::string position(const toml::node& node) const { return position(node.source().begin); }
  std::string start() const { return grid_.file.string() + ":1:1"; }

  void known(const toml::table& table, const Names& names, const char* owner) const {
    for (const auto& [key, node] : table)
      if (std::find(names.begin(), names.end(), key.str()) == names.end())
        config::fail_at(position(key.source().begin), fmt::format("unknown key {} ({} has {}); correct or remove it",
                                                                  key.str(), owner, fmt::join(names, ", ")));
  }

  // Returns the value of a key, null if it is missing. Fails if it has another type.
  template<class Type> const auto* find(const toml::table& table, const char* name, const char* kind) const {
    const toml::node* const node = table.get(name);
    if (node && !node->is<Type>())
      config::fail_at(position(*node), fmt::format("{} must be {}; correct it", name, kind));
    return node ? node->as<Type>() : nullptr;
  }

  std::string absolute(const std::string& path) const {
    return fs::absolute(grid_.file.parent_path() / path).lexically_normal().string();
  }

  // Returns a value as TOML on one line. File names, which are relative to the grid, are made absolute.
  std::string toml_of(const toml::node& node, const std::string& path) const {
    if (const auto* const text = node.as_string())
      return config::to_toml(names_file(path) && !text->get().empty() ? absolute(text->get()) : text->get());
    if (const auto* const flag = node.as_boolean())
      return config::to_toml(flag->get());
    if (const auto* const integer = node.as_integer())
      return config::to_toml(integer->get());
    if (const auto* const number = node.as_floating_point())
      return config::to_toml(number->get());
    Names parts;
    if (const auto* const list = node.as_array()) {
      for (const toml::node& element : *list)
        parts.push_back(toml_of(element, path));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    if (const auto* const table = node.as_table()) {
      for (const auto& [key, inner] : *table)
        parts.push_back(fmt::format("{} = {}", key.str(), toml_of(inner, fmt::format("{}.{}", path, key.str()))));
      return fmt::format("{{ {} }}", fmt::join(parts, ", "));
    }
    config::fail_at(position(node), fmt::format("{} is a date or time (no key takes one); correct it", path));
  }

  static std::string label_of(const toml::node& node, const std::string& toml) {
    if (const auto* const text = node.as_string())
      return text->get();
    if (node.is_floating_point())
      return fmt::format("{}", *node.value<double>()); // 1 for 1.0
    const auto* const list = node.as_array();
    if (!list || !list->is_homogeneous<double>())
      return toml;
    Names parts;
    for (const toml::node& element : *list)
      parts.push_back(label_of(element, {}));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }

  GridValue value_of(const toml::node& node, const std::string& key, const std::string& key_position) const {
    const std::string toml = toml_of(node, key);
    return {{key, toml, key_position, position(node)},
            label_of(node, toml),
            node.is_number() ? node.value<double>() : std::nullopt};
  }

  void read_scene(const toml::table& table) {
    const auto* const scene = find<std::string>(table, "scene", "the path of a scene file, in quotes");
    if (!scene)
      config::fail_at(start(),
                      "scene is missing (the runs need one); add scene = \"FILE.toml\", relative to this file");
    grid_.scene = (grid_.file.parent_path() / scene->get()).lexically_normal();
    if (!fs::is_regular_file(grid_.scene))
      config::fail_at(
          position(*scene),
          fmt::format("the scene {} does not exist (searched as {}); correct the path, which is relative to "
                      "this file",
                      config::to_toml(scene->get()), grid_.scene.string()));
  }

  void read_since(const toml::table& table) {
    const toml::node* const since = table.get("since");
    if (!since)
      return;
    grid_.since_position = position(*since);
    grid_.since = since->is_number() ? since->value<double>() : std::nullopt;
    if (!grid_.since || !std::isfinite(*grid_.since) || *grid_.since < 0.0)
      config::fail_at(grid_.since_position,
                      "since must be a number of orbits, 0 or more; correct it, or remove it so that the "
                      "steady part is detected");
  }

  void read_seeds(const toml::table& table) {
    const auto* const seeds = find<toml::array>(table, "seeds", "a list of whole numbers, as [1, 2, 3]");
    if (!seeds)
      return;
    for (const toml::node& seed : *seeds)
      grid_.seeds.push_back(value_of(seed, seed_key, position(*seeds)));
    if (grid_.seeds.empty())
      config::fail_at(position(*seeds), "seeds is empty (no run would be made); list at least one, or remove the key");
    std::vector<std::vector<GridValue>> points;
    for (const GridValue& seed : grid_.seeds)
      points.push_back({seed});
    refuse_twice(points, "the seed ");
  }

  // Fails if two points have the same values; `what` begins the message.
  static void refuse_twice(const std::vector<std::vector<GridValue>>& points, const char* what) {
    std::set<Names> seen;
    for (const std::vector<GridValue>& point : points) {
      Names labels;
      for (const GridValue& value : point)
        labels.push_back(value.label);
      if (!seen.insert(labels).second)
        config::fail_at(
            point.front().override.value_location,
            fmt::format("{}{} is listed twice (both would be one run); remove one", what, fmt::join(labels, ", ")));
    }
  }

  void read_set(const toml::table& table) {
    if (const auto* const set = find<toml::table>(table, "set", "a table: write [set] and keys of the scene below"))
      add_settings(*set, "");
  }

  // Reads keys and sections: "time.end" = 30.0 and time.end = 30.0 are equivalent; an inline table is a value.
  void add_settings(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      refuse_long(path, position(key.source().begin));
      const toml::table* const inner = node.as_table();
      if (inner && !inner->is_inline())
        add_settings(*inner, path + ".");
      else
        grid_.set.push_back(value_of(node, claimed(path, position(key.source().begin)), position(key.source().begin)));
    }
  }

  // Unknown keys are found later, when a scene is loaded. Their length is limited here, since every value of every run
  // stores its key.
  static void refuse_long(const std::string& key, const std::string& at) {
    constexpr std::size_t max_length = 200;
    if (key.size() > max_length)
      config::fail_at(at,
                      fmt::format("unknown key of {} bytes (no key of a scene is so long); correct it", key.size()));
  }

  // Registers a key of the scene, and returns it. Each key may be given only once.
  std::string claimed(const std::string& key, const std::string& at) {
    constexpr std::size_t max_keys = 1000;
    refuse_long(key, at);
    if (keys_.size() >= max_keys)
      config::fail_at(at, fmt::format("the grid has more than {} keys (no scene has so many); remove some", max_keys));
    if (key == seed_key)
      config::fail_at(at, "particles.seed is given by seeds (a run has one seed); write seeds = [...]");
    if (!keys_.insert(scene::scene_schema().current_path(key)).second)
      config::fail_at(at, fmt::format("{} is given twice in this grid (a run has one value of it); remove one", key));
    return key;
  }

  void read_axes(const toml::table& table) {
    const toml::node* const axes = table.get("axis");
    if (!axes)
      return;
    if (!axes->is_array_of_tables())
      config::fail_at(position(*axes), "axis must be a list of tables; write [[axis]] with a key and its values below");
    for (const toml::node& axis : *axes->as_array())
      grid_.axes.push_back(read_axis(*axis.as_table()));
  }

  GridAxis read_axis(const toml::table& table) {
    known(table, {"key", "keys", "values"}, "an axis");
    GridAxis axis;
    const std::vector<std::string> key_positions = read_keys(table, axis);
    const auto* const values = find<toml::array>(table, "values", "a list of values");
    if (!values || values->empty())
      config::fail_at(values ? position(*values) : position(table),
                      fmt::format("the axis of {} has no values (no run would be made); add values = [...]",
                                  fmt::join(axis.keys, " and ")));
    const bool several = table.contains("keys");
    for (const toml::node& node : *values)
      axis.points.push_back(read_point(node, axis.keys, key_positions, several));
    refuse_twice(axis.points, "");
    return axis;
  }

  std::vector<std::string> read_keys(const toml::table& table, GridAxis& axis) {
    std::vector<std::string> positions;
    const auto* const one = find<std::string>(table, "key", "a key of the scene, in quotes");
    const auto* const several = find<toml::array>(table, "keys", "a list of keys of the scene");
    if ((one != nullptr) == (several != nullptr))
      config::fail_at(position(table),
                      "an axis needs either key or keys; write for example key = \"particles.optical_depth\"");
    const auto add = [&](const toml::node& node) {
      if (!node.is_string())
        config::fail_at(position(node),
                        "a key of an axis must be a string; write for example \"particles.optical_depth\"");
      axis.keys.push_back(claimed(node.as_string()->get(), position(node)));
      positions.push_back(position(node));
    };
    if (one)
      add(*one);
    else
      for (const toml::node& node : *several)
        add(node);
    if (axis.keys.empty())
      config::fail_at(position(*several), "keys is empty (the axis changes nothing); list at least one");
    return positions;
  }

  std::vector<GridValue> read_point(const toml::node& node, const Names& keys, const Names& key_positions,
                                    bool several) const {
    assert(keys.size() == key_positions.size() && !keys.empty());
    std::vector<GridValue> point;
    if (!several)
      return {value_of(node, keys.front(), key_positions.front())};
    const toml::array* const list = node.as_array();
    if (!list || list->size() != keys.size())
      config::fail_at(position(node), fmt::format("this must be a list of {} values, of {}; correct it", keys.size(),
                                                  fmt::join(keys, " and ")));
    for (std::size_t k = 0; k < keys.size(); ++k)
      point.push_back(value_of((*list)[k], keys[k], key_positions[k]));
    return point;
  }

  void read_plot(const toml::table& table) {
    if (!grid_.axes.empty())
      grid_.plot.x = grid_.axes.front().keys.front();
    const auto* const plot = find<toml::table>(table, "plot", "a table: write [plot] and its keys below");
    if (!plot)
      return;
    known(*plot, {"x", "y", "x_log", "y_log"}, "a plot");
    if (const auto* const x = find<std::string>(*plot, "x", "a key of an axis, in quotes")) {
      grid_.plot.x = x->get();
      const bool on_axis = std::any_of(grid_.axes.begin(), grid_.axes.end(), [&](const GridAxis& axis) {
        return std::find(axis.keys.begin(), axis.keys.end(), x->get()) != axis.keys.end();
      });
      if (!on_axis)
        config::fail_at(position(*x),
                        fmt::format("x = {} is not a key of an axis (only these change); name one of them",
                                    config::to_toml(x->get())));
    }
    if (const auto* const y = find<std::string>(*plot, "y", "a column of sweep.csv, in quotes")) {
      grid_.plot.y = y->get();
      grid_.plot.y_position = position(*y);
    }
    if (const auto* const log = find<bool>(*plot, "x_log", "true or false"))
      grid_.plot.x_log = log->get();
    if (const auto* const log = find<bool>(*plot, "y_log", "true or false"))
      grid_.plot.y_log = log->get();
  }

  std::string text_;
  Grid grid_;
  std::set<std::string> keys_; // of [set] and the axes
};

// Returns the named quantities and the plotted one.
batch::RunQuantities quantities_of(const Grid& grid, std::vector<std::string> names,
                                   std::optional<quantities::UnitSystem> units) {
  batch::RunQuantities all(names, units);
  if (!all.find(grid.plot.y) && find_quantity(batch::RunQuantities::known(), grid.plot.y)) {
    names.push_back(grid.plot.y);
    all = batch::RunQuantities(names, units);
  }
  if (all.find(grid.plot.y))
    return all;
  std::vector<std::string> columns;
  for (const batch::RunColumn& column : all.columns())
    columns.push_back(column.name);
  throw UsageError(fmt::format("{}: y = \"{}\" is not measured by a sweep; choose one of {}, or a plain number of "
                               "a run (\"keeler help numbers\" lists them)",
                               grid.plot.y_position, grid.plot.y, fmt::join(columns, ", ")));
}

} // namespace

Grid read_grid(const fs::path& file, const std::vector<std::string>& quantities,
               std::optional<quantities::UnitSystem> units) {
  Grid grid = GridReader(file).read();
  grid.quantities = quantities_of(grid, quantities, units);
  return grid;
}

} // namespace keeler::sweep
