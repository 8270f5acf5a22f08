// keeler complete: prints the completions at the end of a command line. The scripts in src/cli/completion call it, so
// that completions always match the program's options.
#include "command.hpp"
#include "print.hpp"
#include "usage.hpp"

#include <keeler/runs/measurement.hpp>
#include <keeler/scene/examples.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::cli {
namespace {

struct Candidate {
  std::string word, meaning;
};

// The possible completions: words, and names of files that the shell lists itself.
struct Offer {
  std::string names = "none"; // "none", "files" or "folders"
  std::vector<Candidate> candidates{};
};

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

// Returns the option that the word names, with or without "=VALUE"; null when there is none.
const CLI::Option* option_of(const CLI::App& command, const std::string& word) {
  return word.starts_with('-') ? command.get_option_no_throw(word.substr(0, word.find('='))) : nullptr;
}

// The state of a command line at its end.
struct Position {
  const CLI::App* command = nullptr;
  const CLI::Option* option = nullptr; // an option without its value yet; null: an option or argument can follow
  std::vector<const CLI::Option*> given{};
  std::size_t arguments = 0; // positional arguments so far
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
    const bool repeatable = option->get_expected_max() > 1;
    if (!repeatable && std::find(at.given.begin(), at.given.end(), option) != at.given.end())
      continue;
    for (const std::string& name : option->get_lnames())
      candidates.push_back({"--" + name, option->get_description()});
  }
  return candidates;
}

std::vector<Candidate> examples() {
  std::vector<Candidate> candidates;
  for (const scene::ExampleScene& example : scene::example_scenes())
    candidates.push_back({std::string(example.name), std::string(example.about())});
  return candidates;
}

// Returns the keys as "time.step=", or the choices of a key that is complete.
std::vector<Candidate> scene_assignments(const std::string& begun) {
  std::vector<Candidate> candidates;
  if (const std::size_t equals = begun.find('='); equals != std::string::npos) {
    if (const Key* key = scene::find_key(begun.substr(0, equals)))
      for (const std::string& choice : key->choices)
        candidates.push_back({begun.substr(0, equals + 1) + choice, ""});
    return candidates;
  }
  for (const Key& key : scene::scene_keys())
    candidates.push_back({key.path + "=", key.meaning});
  return candidates;
}

// Returns the completions of a comma-separated list of names, of which the last one is incomplete.
std::vector<Candidate> numbers_after(const std::string& begun) {
  const std::string done = begun.substr(0, begun.rfind(',') + 1);
  std::vector<Candidate> candidates;
  for (const quantities::Quantity& quantity : runs::measured_quantities())
    candidates.push_back({done + quantity.full_name(), quantity.meaning});
  return candidates;
}

// Returns the possible values of an option, by its placeholder in --help: "dark|light" are words, "FILE" is a file.
Offer values_of(const CLI::Option& option, const std::string& begun) {
  const std::string placeholder = placeholder_of(option);
  if (placeholder == "NAME")
    return {.candidates = examples()};
  if (placeholder == "NAME,...")
    return {.candidates = numbers_after(begun)};
  if (placeholder.starts_with("SCENE"))
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
  assert(!words.empty());
  const std::string begun = words.back();
  words.pop_back();
  const bool help = !words.empty() && words.front() == "help" && !begun.starts_with('-'); // of a command or subcommand
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
  CLI::App& command = *program.add_subcommand("complete", "print the completions at the end of these words");
  command.group("")->prefix_command();
  command.callback([&command, &program, &action] {
    action = [&command, &program] {
      std::vector<std::string> words = command.remaining();
      if (words.size() < 2)
        throw UsageError(
            "the words to complete begin with 'keeler'; write for example \"keeler complete keeler run --\"");
      words.erase(words.begin());
      return complete(program, words);
    };
  });
}

} // namespace keeler::cli
