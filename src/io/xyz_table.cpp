// Tables of particles as extended XYZ: the number of rows; a line of KEY=VALUE, with the columns in Properties and the
// box in Lattice and Origin; a row per particle.
#include "table_columns.hpp"
#include "table_files.hpp"
#include "text_rows.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/columns.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

namespace keeler::io {

namespace {

// A property, its columns here, and other names that OVITO and ASE give it.
struct Property {
  const char* name;
  std::vector<const char*> columns;
  std::vector<std::string_view> others;
};

const std::vector<Property>& properties() {
  static const std::vector<Property> all = {{"id", {"id"}, {}},
                                            {"pos", {"x", "y", "z"}, {"positions"}},
                                            {"velo", {"vx", "vy", "vz"}, {"velocities", "velocity", "vel"}},
                                            {"radius", {"r"}, {"radii"}},
                                            {"mass", {"m"}, {"masses"}},
                                            {"spin", {"sx", "sy", "sz"}, {"angular_velocity", "spins"}}};
  return all;
}

[[noreturn]] void refuse_line(const std::string& file, int line, const std::string& fault) {
  throw UsageError(fmt::format("{}:{}: {}", file, line, fault));
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(line);
}

// Takes the next word, which blanks end.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, std::min(text.find_first_of(" \t"), text.size()));
  text.remove_prefix(word.size());
  return word;
}

std::optional<std::size_t> count_in(std::string_view line) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), count);
  return error == std::errc() && end == line.data() + line.size() ? std::optional(count) : std::nullopt;
}

// Returns KEY=VALUE or KEY="VALUE" of a line; keys in lower case.
std::map<std::string, std::string> pairs_in(std::string_view line, const std::string& file) {
  std::map<std::string, std::string> pairs;
  while (!(line = trimmed(line)).empty()) {
    std::string key(line.substr(0, std::min(line.find_first_of("= \t"), line.size())));
    line.remove_prefix(key.size());
    std::string value;
    if (line.starts_with("=\"")) {
      const std::size_t end = line.find('"', 2);
      if (end == std::string_view::npos)
        refuse_line(file, 2, fmt::format("the value of {} has no closing quote; add it", key));
      value = line.substr(2, end - 2);
      line.remove_prefix(end + 1);
    } else if (line.starts_with("=")) {
      line.remove_prefix(1);
      value = take_word(line);
    }
    std::transform(key.begin(), key.end(), key.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    pairs[key] = value;
  }
  return pairs;
}

std::vector<double> row_numbers(std::string_view text, std::size_t count, const char* key, const std::string& file) {
  std::vector<double> numbers;
  while (!trimmed(text).empty()) {
    const std::string_view word = take_word(text);
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number))
      refuse_line(file, 2, fmt::format("{} has '{}', which is no number; correct it", key, word));
    numbers.push_back(number);
  }
  if (numbers.size() != count)
    refuse_line(file, 2, fmt::format("{} has {} numbers, not {}; correct it", key, numbers.size(), count));
  return numbers;
}

// What Properties says of a row: the columns to read, by their names here, and which words are texts to leave out.
struct RowLayout {
  std::string names;
  std::vector<bool> is_text;
};

RowLayout layout_in(const std::string& text, const std::string& file) {
  RowLayout layout;
  std::vector<std::string> words;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    words.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (words.empty() || words.size() % 3 != 0)
    refuse_line(file, 2,
                "Properties are not NAME:TYPE:COUNT:…; write them as id:I:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1");
  for (std::size_t k = 0; k < words.size(); k += 3) {
    std::string name = words[k];
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::size_t columns = count_in(words[k + 2]).value_or(0);
    if (columns == 0 || columns > 9)
      refuse_line(file, 2, fmt::format("the property {} has {} columns; correct Properties", words[k], words[k + 2]));
    const bool is_text = words[k + 1] == "S";
    layout.is_text.insert(layout.is_text.end(), columns, is_text);
    if (is_text)
      continue;
    const auto known = std::find_if(properties().begin(), properties().end(), [&](const Property& property) {
      return name == property.name ||
             std::find(property.others.begin(), property.others.end(), name) != property.others.end();
    });
    if (known == properties().end())
      refuse_line(file, 2,
                  fmt::format("unknown property '{}'; remove it (the properties are id, pos, velo, radius, mass, spin)",
                              words[k]));
    if (known->columns.size() != columns)
      refuse_line(
          file, 2,
          fmt::format("the property {} has {} columns, not {}; correct it", words[k], columns, known->columns.size()));
    for (const char* column : known->columns)
      layout.names += fmt::format("{} ", column);
  }
  return layout;
}

// The box of a file, and where its centre is.
struct Cell {
  TableFrame frame;
  Vec3 centre = Vec3::Zero();
};

Cell cell_in(const std::map<std::string, std::string>& pairs, const std::string& file) {
  Cell cell;
  const auto value = [&](const char* key) {
    const auto found = pairs.find(key);
    return found == pairs.end() ? std::string() : found->second;
  };
  if (!value("omega").empty())
    cell.frame.orbital_frequency = row_numbers(value("omega"), 1, "Omega", file)[0];
  if (value("lattice").empty())
    return cell;
  const std::vector<double> v = row_numbers(value("lattice"), 9, "Lattice", file);
  for (const std::size_t k : {2U, 3U, 5U, 6U, 7U})
    if (v[k] != 0.0)
      refuse_line(file, 2, "Lattice is no shearing box; give \"L_x -OFFSET 0 0 L_y 0 0 0 L_z\"");
  if (!(v[0] > 0.0 && v[4] > 0.0))
    refuse_line(file, 2, "Lattice has a side of 0 or less; correct it");
  const double offset = std::fmod(-v[1], v[4]);
  cell.frame.size_x = v[0];
  cell.frame.size_y = v[4];
  cell.frame.shear_offset = offset < 0.0 ? offset + v[4] : offset;
  cell.centre = 0.5 * Vec3(v[0], v[1] + v[4], v[8]);
  if (!value("origin").empty()) {
    const std::vector<double> origin = row_numbers(value("origin"), 3, "Origin", file);
    cell.centre += Vec3(origin[0], origin[1], origin[2]);
  }
  return cell;
}

// Returns the rows without their texts. Throws UsageError unless there are `count`.
std::string rows_of(std::string_view text, std::size_t count, const RowLayout& layout, const std::string& file) {
  const bool has_texts = std::find(layout.is_text.begin(), layout.is_text.end(), true) != layout.is_text.end();
  std::string rows;
  std::size_t found = 0;
  for (int line_number = 3; !text.empty(); ++line_number) {
    std::string_view line = take_line(text);
    if (!line.empty() && ++found > count)
      refuse_line(file, line_number,
                  fmt::format("there are more than {} rows, or several frames; keep one frame", count));
    if (!has_texts) {
      rows += line;
    } else {
      for (std::size_t word_number = 0; !trimmed(line).empty(); ++word_number) {
        const std::string_view word = take_word(line);
        if (word_number >= layout.is_text.size() || !layout.is_text[word_number])
          rows.append(word) += ' ';
      }
    }
    rows += '\n';
  }
  if (found < count)
    refuse_line(file, 1, fmt::format("{} rows are announced, and there are {}; write the file again", count, found));
  return rows;
}

} // namespace

bool is_xyz(std::string_view text) {
  const std::string_view first = take_line(text);
  return count_in(first).has_value() && take_line(text).find("Properties=") != std::string_view::npos;
}

ParticleTable read_xyz_table(std::string_view text, const std::string& file) {
  assert(is_xyz(text));
  const std::size_t count = *count_in(take_line(text));
  require_rows(count, file);
  const std::map<std::string, std::string> pairs = pairs_in(take_line(text), file);
  const RowLayout layout = layout_in(pairs.at("properties"), file);
  const Cell cell = cell_in(pairs, file);
  // As a table with a line of names, in the same lines of the file.
  files::Columns columns = files::parse_columns("\n" + layout.names + "\n" + rows_of(text, count, layout, file), file);
  ParticleTable table =
      table_of(file, assign_columns(columns.names, std::move(columns.values), fmt::format("{}:2", file)),
               std::move(columns.lines));
  for (Vec3& position : table.positions)
    position -= cell.centre;
  table.frame = cell.frame;
  return table;
}

void write_xyz_table(const std::filesystem::path& file, const ParticleTable& table) {
  const std::vector<std::size_t> columns = columns_in(table);
  std::string head = fmt::format("{}\n", table.size());
  if (const TableFrame& frame = table.frame; frame.has_box()) {
    double height = 0.0;
    for (std::size_t k = 0; k < table.size(); ++k)
      height = std::max(height, 2.0 * (std::fabs(table.positions[k].z()) + table.radii[k]));
    // The image at +L_x is shifted by -offset; of the equal lattices the one that is skewed least.
    const double along =
        frame.shear_offset <= 0.5 * frame.size_y ? -frame.shear_offset : frame.size_y - frame.shear_offset;
    const Vec3 origin = -0.5 * Vec3(frame.size_x, along + frame.size_y, height);
    head += fmt::format("Lattice=\"{} {} 0 0 {} 0 0 0 {}\" Origin=\"{} {} {}\" pbc=\"T T F\" Time={} ", frame.size_x,
                        along, frame.size_y, height, origin.x(), origin.y(), origin.z(), frame.time_orbits);
    if (frame.orbital_frequency > 0.0)
      head += fmt::format("Omega={} ", frame.orbital_frequency);
  }
  head += "Properties=id:I:1";
  const auto has = [&](const char* name) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](std::size_t column) { return std::string_view(table_columns()[column].name) == name; });
  };
  for (const Property& property : properties())
    if (has(property.columns.front()))
      head += fmt::format(":{}:R:{}", property.name, property.columns.size());
  write_rows(file, head + "\n", table.size(), [&](fmt::memory_buffer& row, std::size_t k) {
    fmt::format_to(std::back_inserter(row), FMT_COMPILE("{}"), id_of(table, k));
    for (const std::size_t column : columns)
      fmt::format_to(std::back_inserter(row), FMT_COMPILE(" {}"), value_in(table, column, k));
    row.push_back('\n');
  });
}

} // namespace keeler::io
