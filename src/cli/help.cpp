// keeler help, and what --help ends with.
#include "command.hpp"
#include "man_page.hpp"
#include "print.hpp"
#include "usage.hpp"

#include <keeler/core/suggest.hpp>

#include <fmt/format.h>

#include <memory>

namespace keeler {
namespace {

// The command of these words: {"bench", "drift"}.
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
      const std::string near = closest(word, names);
      throw UsageError(
          fmt::format("'{}' has no command '{}'; {}", full_name(*command), word,
                      near.empty() ? "\"keeler help\" lists the commands" : fmt::format("did you mean '{}'?", near)));
    }
    command = found;
  }
  return *command;
}

} // namespace

void examples_of(CLI::App& command, const std::vector<std::string>& lines) {
  std::string footer = "Examples:";
  for (const std::string& line : lines)
    footer += "\n  " + line;
  command.footer(footer);
}

ExitCode print_help(const CLI::App& command) {
  print("{}", command.get_formatter()->make_help(&command, full_name(command), CLI::AppFormatMode::Normal));
  return ExitCode::done;
}

void add_help(CLI::App& program, Action& action) {
  struct HelpOptions {
    std::vector<std::string> words;
    bool man = false;
  };
  const auto options = std::make_shared<HelpOptions>();
  CLI::App& command = *program.add_subcommand("help", "list the commands, or say what a command does");
  command.add_option("COMMAND", options->words, "a command, and its part: bench drift")->type_name("");
  command.add_flag("--man", options->man, "print it as the source of a manual page, for man -l");
  examples_of(command, {"keeler help run", "keeler help bench drift", "keeler help run --man"});
  command.callback([options, &program, &action] {
    action = [options, &program] {
      const CLI::App& about = find_command(program, options->words);
      return options->man ? print_man_page(about) : print_help(about);
    };
  });
}

} // namespace keeler
