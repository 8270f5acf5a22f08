// keeler help, and the examples at the end of --help.
#include "command.hpp"
#include "number_tables.hpp"
#include "print.hpp"
#include "usage.hpp"

#include <keeler/core/suggest.hpp>
#include <keeler/runs/measurement.hpp>
#include <keeler/runs/series_columns.hpp>
#include <keeler/runs/summary.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <memory>
#include <utility>

namespace keeler::cli {
namespace {

constexpr const char* the_whole =
    "the whole program, build/default/keeler, is made by \"cmake --build build/default --target keeler\"";

std::vector<NumberTable> number_tables() {
  std::vector<NumberTable> tables = {
      {"keeler analyze: a snapshot, or the steady part of a run", runs::measured_quantities()},
      {"summary.json: results of a run (keeler run --json)", runs::summary_quantities()},
      {"series.csv: time series of a run", runs::series_quantities()}};
  for (NumberTable& table : further_number_tables())
    tables.push_back(std::move(table));
  return tables;
}

std::string line_of(const quantities::Quantity& quantity) {
  std::string names;
  for (const quantities::UnitSystem system : quantity.systems())
    names += (names.empty() ? "" : ", ") + quantity.full_name(system);
  return fmt::format("  {:<40} {}{}\n", names, quantity.meaning,
                     quantity.unit.text.empty() ? "" : fmt::format(" ({})", quantity.unit.text));
}

ExitCode list_numbers() {
  for (const NumberTable& table : number_tables()) {
    print("{}\n", table.title);
    for (const quantities::Quantity& quantity : table.quantities)
      print("{}", line_of(quantity));
    print("\n");
  }
  return ExitCode::done;
}

// Prints the numbers that are asked for, below the titles of their tables. Returns false if there are none.
bool explain_numbers(const std::function<bool(const quantities::Quantity&)>& asked) {
  bool is_known = false;
  for (const NumberTable& table : number_tables()) {
    std::string lines;
    for (const quantities::Quantity& quantity : table.quantities)
      if (asked(quantity))
        lines += line_of(quantity);
    if (!lines.empty())
      print("{}\n{}", table.title, lines);
    is_known = is_known || !lines.empty();
  }
  return is_known;
}

bool is_labelled(const quantities::Quantity& quantity, const std::string& words) {
  const std::size_t indent = quantity.label.find_first_not_of(' ');
  return indent != std::string::npos && quantity.label.substr(indent) == words;
}

// Returns whether a name or a label has these words in it, of three letters or more.
bool mentions(const quantities::Quantity& quantity, const std::string& words) {
  return words.size() >= 3 &&
         (quantity.full_name().find(words) != std::string::npos || quantity.label.find(words) != std::string::npos);
}

// Prints the keys of a scene that are called so. Returns false if there are none.
bool explain_keys(const std::string& name) {
  const std::string lines = scene::describe_keys_called(name);
  if (!lines.empty())
    print("scene.toml: keys of a scene\n{}", lines);
  return !lines.empty();
}

bool is_command(const CLI::App& program, const std::string& word) {
  const std::vector<const CLI::App*> commands = listed_commands(program);
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App* command) { return command->get_name() == word; });
}

// Adds the names of numbers, and of keys of a scene, their last parts and their tables.
void add_names(std::vector<std::string>& names) {
  for (const NumberTable& table : number_tables())
    for (const quantities::Quantity& quantity : table.quantities)
      names.insert(names.end(), {quantity.name, quantity.full_name()});
  for (const Key& key : scene::scene_keys()) {
    const std::size_t dot = key.path.rfind('.');
    names.push_back(key.path);
    if (dot != std::string::npos)
      names.insert(names.end(), {key.path.substr(0, dot), key.path.substr(dot + 1)});
  }
}

// Returns the command named by these words, such as {"bench", "drift"}. Throws UsageError with a suggestion.
const CLI::App& find_command(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* command = &program;
  for (const std::string& word : words) {
    std::vector<std::string> names;
    const CLI::App* found = nullptr;
    for (const CLI::App* below : listed_commands(*command)) {
      names.push_back(below->get_name());
      if (below->get_name() == word)
        found = below;
    }
    if (!found) {
      if (command == &program)
        add_names(names);
      std::erase(names, word); // known, but not as a command with the words behind it
      const std::string near = closest(word, names);
      throw UsageError(fmt::format("'{}' has no command '{}'; {}", full_name(*command), word,
                                   near.empty()
                                       ? "\"keeler help\" lists the commands, \"keeler help numbers\" the numbers, "
                                         "\"keeler check --defaults\" the keys of a scene"
                                       : fmt::format("did you mean '{}'?", near)));
    }
    command = found;
  }
  return *command;
}

} // namespace

void examples_of(CLI::App& command, const std::vector<std::string>& lines) {
  assert(!lines.empty());
  std::string footer = "Examples:";
  for (const std::string& line : lines)
    footer += "\n  " + line;
  command.footer(footer);
}

ExitCode print_help(const CLI::App& command) {
  print("{}", command.get_formatter()->make_help(&command, full_name(command), CLI::AppFormatMode::Normal));
  return ExitCode::done;
}

void leave_out(CLI::App& program, Action& action, const char* name) {
  CLI::App& command = *program.add_subcommand(name, "not in the demo's program");
  command.footer(the_whole);
  command.set_help_flag(); // --help is a word as any other
  command.prefix_command();
  command.callback([name, &action] {
    action = [name]() -> ExitCode {
      throw UsageError(fmt::format("'keeler {}' is not in the demo's program; {}", name, the_whole));
    };
  });
}

void add_help(CLI::App& program, Action& action) {
  const auto words = std::make_shared<std::vector<std::string>>();
  CLI::App& command = *program.add_subcommand("help", "list the commands, or explain a command, a number or a key");
  command
      .add_option("COMMAND", *words,
                  "a command, with a subcommand: bench drift; \"numbers\", or a number by its name, its label or a "
                  "part of them; a key of a scene, its last part, or a table")
      ->type_name("");
  examples_of(command, {"keeler help run", "keeler help bench drift", "keeler help numbers", "keeler help toomre_q",
                        "keeler help viscosity", "keeler help gravity.solver"});
  command.callback([words, &program, &action] {
    action = [words, &program] {
      if (words->size() == 1 && words->front() == "numbers")
        return list_numbers();
      const std::string name = fmt::format("{}", fmt::join(*words, " "));
      using quantities::Quantity;
      const bool is_other = !words->empty() && !is_command(program, words->front());
      const bool is_key = is_other && explain_keys(name);
      if (explain_numbers([&](const Quantity& one) { return one.is_called(name) || is_labelled(one, name); }) ||
          (is_other && explain_numbers([&](const Quantity& one) { return mentions(one, name); })) || is_key)
        return ExitCode::done;
      return print_help(find_command(program, *words));
    };
  });
}

} // namespace keeler::cli
