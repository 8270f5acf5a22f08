#include "man_page.hpp"

#include "print.hpp"
#include "usage.hpp"

#include <keeler/core/version.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace keeler {
namespace {

struct Exit {
  ExitCode code;
  const char* meaning;
};

// As in docs/manual/commands.md.
constexpr Exit exits[] = {
    {ExitCode::done, "all that was asked is done"},
    {ExitCode::run_time, "an error that none of the following covers"},
    {ExitCode::usage, "the command line or the scene is wrong"},
    {ExitCode::invariant, "a physical invariant broke, for example overlapping particles in a start file"},
    {ExitCode::input_output, "reading or writing failed: a full disk, a damaged file, a folder that cannot be made"},
    {ExitCode::stopped, "stopped early on request, a valid checkpoint is on disk"}};

// Escapes text for roff: '-' becomes a minus sign that can be copied, and no line begins with a request.
std::string roff(const std::string& text) {
  std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char letter : text)
    escaped += letter == '\\' ? "\\e" : letter == '-' ? "\\-" : std::string(1, letter);
  return escaped;
}

// Returns the name of a command's page: "keeler-run".
std::string page_name(const CLI::App& command) {
  std::string name = full_name(command);
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

void print_tagged(const std::string& tag, const std::string& text) {
  print(".TP\n{}\n{}\n", tag, roff(text));
}

std::string usage_of(const CLI::App& command) {
  std::string usage = full_name(command);
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional() && option->get_required())
      usage += " " + option->get_name() + " " + placeholder_of(*option);
  usage += " [OPTION]...";
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      usage += option->get_required() ? " " + placeholder_of(*option) : " [" + placeholder_of(*option) + "]";
  return listed_commands(command).empty() ? usage : usage + " COMMAND";
}

std::string explained(const CLI::Option& option) {
  std::string text = option.get_description();
  if (option.get_required())
    text += "; required";
  for (const CLI::Option* other : option.get_excludes())
    text += "; not with " + other->get_name();
  for (const CLI::Option* other : option.get_needs())
    text += "; only with " + other->get_name();
  return text;
}

void print_options(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      print_tagged(fmt::format("\\fI{}\\fR", roff(placeholder_of(*option))), explained(*option));
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional())
      print_tagged(
          fmt::format("\\fB{}\\fR \\fI{}\\fR", roff(option->get_name(false, true)), roff(placeholder_of(*option))),
          explained(*option));
}

void print_commands(const CLI::App& program) {
  std::string group;
  for (const CLI::App* command : listed_commands(program)) {
    if (command->get_group() != group)
      print(".SS {}\n", group = command->get_group());
    print_tagged(fmt::format("\\fB{}\\fR(1)", roff(page_name(*command))), command->get_description());
  }
}

void print_parts(const CLI::App& command) {
  for (const CLI::App* part : listed_commands(command)) {
    print(".SS {}\n{}.\n.PP\n.B {}\n", roff(full_name(*part)), roff(part->get_description()), roff(usage_of(*part)));
    print_options(*part);
  }
}

// Prints the lines of --help below "Examples:" of the command and its subcommands.
void print_examples(const CLI::App& command) {
  for (const std::string& line : CLI::detail::split(command.get_footer(), '\n'))
    if (line.starts_with("  "))
      print("{}\n", roff(line.substr(2)));
  if (command.get_parent())
    for (const CLI::App* part : listed_commands(command))
      print_examples(*part);
}

} // namespace

ExitCode print_man_page(const CLI::App& command) {
  if (command.get_parent() && command.get_parent()->get_parent())
    return print_man_page(*command.get_parent());
  const bool program = command.get_parent() == nullptr;
  std::string title = page_name(command);
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char letter) { return std::toupper(letter); });
  print(".TH {} 1 \"\" \"keeler {}\" \"Keeler\"\n", title, program_version());
  print(".SH NAME\n{} \\- {}\n", roff(page_name(command)), roff(command.get_description()));
  print(".SH SYNOPSIS\n.B {}\n", roff(usage_of(command)));
  print(".SH OPTIONS\n");
  print_options(command);
  if (!listed_commands(command).empty())
    print(".SH COMMANDS\n");
  program ? print_commands(command) : print_parts(command);
  print(".SH EXIT STATUS\n");
  for (const Exit& exit : exits)
    print_tagged(fmt::format("\\fB{}\\fR", static_cast<int>(exit.code)), exit.meaning);
  print(".SH EXAMPLES\n.nf\n");
  print_examples(command);
  print(".fi\n.SH SEE ALSO\n{}the manual (commands, scene keys, a tutorial), in the folder doc/keeler beside the "
        "folder of this page.\n",
        program ? "" : "\\fBkeeler\\fR(1), ");
  return ExitCode::done;
}

} // namespace keeler
