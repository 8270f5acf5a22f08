// keeler complete: what a shell may offer at the end of a command line. The scripts in src/cli/completion ask it, so
// that it follows the options by itself.
#include "command.hpp"
#include "print.hpp"
#include "usage.hpp"

#include <keeler/runs/measurement.hpp>
#include <keeler/scene/examples.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace keeler {
namespace {

struct Candidate {
  std::string word, meaning;
};

// What can follow: these words, and names that only the shell knows.
struct Offer {
  std::string names = "none"; // "none", "files" or "folders"
  std::vector<Candidate> candidates{};
};

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

// The option that the word names, with or without a value behind '='; null when there is none.
const CLI::Option* option_of(const CLI::App& command, const std::string& word) {
  return word.starts_with('-') ? command.get_option_no_throw(word.substr(0, word.find('='))) : nullptr;
}

// What a command line asks for at its end.
struct Position {
  const CLI::App* command = nullptr;
  const CLI::Option* option = nullptr; // whose value is expected; null: an option or an argument is
  std::vector<const CLI::Option*> given{};
  std::size_t arguments = 0; // that stand already
};

Position position_after(const CLI::App& program, const std::vector<std::string>& words) {
  Position at{.command = &program};
  for (const std::string& word : words) {
    if (at.option) {
      at.option = nullptr;
      continue;
    }
    if (const CLI::Option* option = option_of(*at.command, word)) {
      at.given.push_back(option);
      if (!is_flag(*option) && word.find('=') == std::string::npos)
        at.option = option;
      continue;
    }
    const std::vector<const CLI::App*> below = listed_commands(*at.command);
    const auto named = std::find_if(below.begin(), below.end(), [&](auto* app) { return app->get_name() == word; });
    if (named != below.end())
      at = Position{.command = *named};
    else if (!word.starts_with('-'))
      ++at.arguments;
  }
  return at;
}

std::vector<Candidate> commands_below(const CLI::App& command) {
  std::vector<Candidate> candidates;
  for (const CLI::App* below : listed_commands(command))
    candidates.push_back({below->get_name(), below->get_description()});
  return candidates;
}

std::vector<Candidate> options_of(const Position& at) {
  std::vector<Candidate> candidates;
  for (const CLI::Option* option : at.command->get_options()) {
    const bool again = option->get_expected_max() > 1;
    if (!again && std::find(at.given.begin(), at.given.end(), option) != at.given.end())
      continue;
    for (const std::string& name : option->get_lnames())
      candidates.push_back({"--" + name, option->get_description()});
  }
  return candidates;
}

std::vector<Candidate> examples() {
  std::vector<Candidate> candidates;
  for (const ExampleScene& example : example_scenes())
    candidates.push_back({std::string(example.name), std::string(example.about())});
  return candidates;
}

// "step.length=", and when the key stands already, the words that it can be.
std::vector<Candidate> scene_assignments(const std::string& begun) {
  std::vector<Candidate> candidates;
  if (const std::size_t equals = begun.find('='); equals != std::string::npos) {
    if (const Key* key = find_key(begun.substr(0, equals)))
      for (const std::string& choice : key->choices)
        candidates.push_back({begun.substr(0, equals + 1) + choice, ""});
    return candidates;
  }
  for (const Key& key : scene_keys())
    candidates.push_back({key.path + "=", key.meaning});
  return candidates;
}

// Names with commas between them: the last one is still being written.
std::vector<Candidate> numbers_after(const std::string& begun) {
  const std::string done = begun.substr(0, begun.rfind(',') + 1);
  std::vector<Candidate> candidates;
  for (const Quantity& quantity : measured_quantities())
    candidates.push_back({done + quantity.full_name(), quantity.meaning});
  return candidates;
}

// What stands in --help for a value says what it can be: "dark|light" are its words, "FILE" the name of a file.
Offer values_of(const CLI::Option& option, const std::string& begun) {
  const std::string placeholder = placeholder_of(option);
  if (placeholder == "NAME")
    return {.candidates = examples()};
  if (placeholder == "NAME,...")
    return {.candidates = numbers_after(begun)};
  if (placeholder == "SCENE")
    return {.names = "files", .candidates = examples()};
  if (placeholder == "KEY=VALUE")
    return {.candidates = scene_assignments(begun)};
  if (placeholder == "DIR")
    return {.names = "folders"};
  if (placeholder.find("FILE") != std::string::npos || placeholder == "GRID")
    return {.names = "files"};
  Offer offer;
  if (placeholder.find('|') != std::string::npos)
    for (const std::string& word : CLI::detail::split(placeholder, '|'))
      offer.candidates.push_back({word, ""});
  return offer;
}

Offer offer_at(const Position& at, const std::string& begun) {
  if (at.option)
    return values_of(*at.option, begun);
  const std::size_t equals = begun.find('=');
  if (const CLI::Option* option = option_of(*at.command, begun); option && equals != std::string::npos) {
    Offer offer = values_of(*option, begun.substr(equals + 1));
    for (Candidate& candidate : offer.candidates)
      candidate.word = begun.substr(0, equals + 1) + candidate.word;
    return offer;
  }
  if (begun.starts_with('-'))
    return {.candidates = options_of(at)};
  if (const std::vector<Candidate> commands = commands_below(*at.command); !commands.empty())
    return {.candidates = commands};
  std::size_t argument = 0;
  for (const CLI::Option* option : at.command->get_options())
    if (option->get_positional() && (argument++ == at.arguments || option->get_expected_max() > 1))
      return values_of(*option, begun);
  return {};
}

ExitCode complete(const CLI::App& program, std::vector<std::string> words) {
  const std::string begun = words.back();
  words.pop_back();
  const bool help = !words.empty() && words.front() == "help" && !begun.starts_with('-'); // of a command or its part
  if (help)
    words.erase(words.begin());
  const Position at = position_after(program, words);
  const Offer offer = help ? Offer{.candidates = commands_below(*at.command)} : offer_at(at, begun);
  print("{}\n", offer.names);
  for (const Candidate& candidate : offer.candidates)
    if (candidate.word.starts_with(begun))
      print("{}\t{}\n", candidate.word, candidate.meaning);
  return ExitCode::done;
}

} // namespace

void add_complete(CLI::App& program, Action& action) {
  CLI::App& command = *program.add_subcommand("complete", "what a shell may offer at the end of these words");
  command.group("")->prefix_command();
  command.callback([&command, &program, &action] {
    action = [&command, &program] {
      std::vector<std::string> words = command.remaining();
      if (words.size() < 2)
        throw UsageError("what the shell completes begins with 'keeler'; ask as in \"keeler complete keeler run --\"");
      words.erase(words.begin());
      return complete(program, words);
    };
  });
}

} // namespace keeler
