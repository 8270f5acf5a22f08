#include "usage.hpp"

#include <keeler/core/suggest.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace keeler::cli {
namespace {

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

std::string or_help(const CLI::App& command, const std::string& near) {
  return near.empty() ? fmt::format("\"{} --help\" lists commands and options", full_name(command))
                      : fmt::format("did you mean '{}'?", near);
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-';
}

// Rewords the common messages of CLI11; returns others unchanged.
std::string describe_fault(const CLI::App& command, const CLI::ParseError& error) {
  const std::string text = error.what();
  const auto between = [&](const std::string& before, const std::string& after) {
    const std::size_t begin = text.find(before), end = text.find(after, begin + before.size());
    return begin == text.npos || end == text.npos ? text
                                                  : text.substr(begin + before.size(), end - begin - before.size());
  };
  if (dynamic_cast<const CLI::ConversionError*>(&error) && text.find(" = ") != text.npos)
    return fmt::format("{}: '{}' is not a number", between("convert: ", " = "), text.substr(text.find(" = ") + 3));
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !command.remaining().empty())
    return fmt::format("'{}' takes no further argument '{}'", full_name(command), command.remaining().front());
  if (!dynamic_cast<const CLI::ArgumentMismatch*>(&error))
    return text;
  for (const CLI::Option* option : command.get_options())
    if (const auto given = static_cast<int>(option->results().size()); given > option->get_items_expected_max())
      return fmt::format("{} is given {} times, and takes one value", option->get_name(), given);
  return text.ends_with(" missing") ? between("", ": ") + " has no value" : text;
}

} // namespace

const CLI::App& asked_command(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty())
    command = command->get_subcommands().front();
  return *command;
}

std::string full_name(const CLI::App& command) {
  return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name() : command.get_name();
}

std::vector<const CLI::App*> listed_commands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* app) { return !app->get_group().empty(); });
}

std::string placeholder_of(const CLI::Option& option) {
  if (option.get_positional())
    return option.get_name(true);
  return option.get_items_expected_max() == 0 ? "" : option.get_type_name();
}

std::string usage_fault(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = asked_command(program);
  const std::vector<std::string> words = command.remaining();
  std::vector<std::string> names;
  for (const CLI::App* below : listed_commands(command))
    names.push_back(below->get_name());
  if (!names.empty() && words.empty())
    return fmt::format("'{}' needs a subcommand: {}", full_name(command), fmt::join(names, ", "));
  if (!names.empty() && !is_option(words.front()))
    return fmt::format("'{}' has no command '{}'; {}", full_name(command), words.front(),
                       or_help(command, closest(words.front(), names)));
  // An unknown option is the likely cause of an unexpected word or a missing value, so it is reported first.
  for (const std::string& word : words)
    if (is_option(word)) {
      const std::string name = word.substr(0, word.find('='));
      return fmt::format("'{}' has no option '{}'; {}", full_name(command), name,
                         or_help(command, closest(name, option_names(command))));
    }
  return fmt::format("{}; {}", describe_fault(command, error), or_help(command, ""));
}

} // namespace keeler::cli
