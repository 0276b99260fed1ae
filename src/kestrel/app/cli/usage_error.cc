// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/usage_error.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "kestrel/core/base/edit_distance.h"

namespace kestrel {
namespace {

// A command line as far as it names commands: "kestrel simulate landing", and the words after it.
struct Parsed {
  const CLI::App* command;
  std::string name;
  std::vector<std::string> rest;
};

Parsed ParseCommands(const CLI::App& app, const std::vector<std::string>& words) {
  Parsed parsed{&app, app.get_name(), words};
  while (!parsed.command->get_subcommands().empty()) {
    parsed.command = parsed.command->get_subcommands().front();
    parsed.name += " " + parsed.command->get_name();
    const auto named =
        std::find(parsed.rest.begin(), parsed.rest.end(), parsed.command->get_name());
    if (named != parsed.rest.end()) parsed.rest.erase(parsed.rest.begin(), named + 1);
  }
  return parsed;
}

std::vector<std::string> NamesOfCommands(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(each->get_name());
  }
  return names;
}

std::vector<std::string> NamesOfOptions(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// Returns "; did you mean 'land'?", or nothing when none of 'names' is near.
std::string Suggestion(const std::string& typed, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  const std::string& nearest = NearestName(typed, names);
  return IsNearName(typed, nearest) ? fmt::format("; did you mean '{}'?", nearest) : "";
}

// The first word of 'rest' where a command was expected.
std::optional<std::string> UnknownCommand(const Parsed& parsed) {
  if (NamesOfCommands(*parsed.command).empty() || parsed.rest.empty()) return std::nullopt;
  const std::string& word = parsed.rest.front();
  return word.starts_with("-") ? std::nullopt : std::optional(word);
}

// A file whose name an option hides: "-x.png".
std::optional<std::string> HiddenFile(const std::vector<std::string>& words) {
  std::error_code ignored;
  for (const std::string& word : words) {
    if (word.starts_with("-") && std::filesystem::exists(word, ignored)) return word;
  }
  return std::nullopt;
}

// The first option among the words that were not expected.
std::optional<std::string> UnknownOption(const CLI::App& app) {
  for (const std::string& word : app.remaining(/*recurse=*/true)) {
    if (word.starts_with("--")) return word.substr(0, word.find('='));
  }
  return std::nullopt;
}

std::string UnknownOptionInWords(const std::string& option, const Parsed& parsed) {
  const std::vector<std::string> known = NamesOfOptions(*parsed.command);
  if (std::find(known.begin(), known.end(), option) != known.end()) {
    return fmt::format("{} has to stand behind the command", option);
  }
  return fmt::format("there is no option '{}'{}", option, Suggestion(option, known));
}

// Returns what stands before 'mark' in 'text', and what after it; nothing when it is not there.
std::optional<std::pair<std::string, std::string>> Split(const std::string& text,
                                                         std::string_view mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + mark.size()));
}

// Returns the parser's message in our words.
std::string Reworded(const std::string& message) {
  if (const auto parts = Split(message, ": At Most 1 required but received ")) {
    return fmt::format("{} is given {} times, expected once", parts->first, parts->second);
  }
  if (const auto parts = Split(message, ": 1 required "); parts && message.ends_with(" missing")) {
    return fmt::format("{}: expected {}", parts->first,
                       parts->second.substr(0, parts->second.rfind(' ')));
  }
  if (const auto parts = Split(message, "Could not convert: "); parts && parts->first.empty()) {
    if (const auto value = Split(parts->second, " = ")) {
      return fmt::format("{}: got '{}', expected a number", value->first, value->second);
    }
  }
  if (const auto parts = Split(message, " not in {"); parts && message.ends_with("}")) {
    const std::size_t colon = parts->first.find(": ") + 2;
    return fmt::format("{}got '{}', expected one of {}", parts->first.substr(0, colon),
                       parts->first.substr(colon),
                       parts->second.substr(0, parts->second.size() - 1));
  }
  return message;
}

}  // namespace

std::string UsageErrorInWords(const CLI::App& app, const CLI::ParseError& error,
                              const std::vector<std::string>& words) {
  const Parsed parsed = ParseCommands(app, words);
  std::string what = Reworded(error.what());
  if (const auto file = HiddenFile(parsed.rest)) {
    what = fmt::format("'{0}' is read as an option: write ./{0} for the file", *file);
  } else if (const auto word = UnknownCommand(parsed)) {
    what = fmt::format("there is no command '{}'{}", *word,
                       Suggestion(*word, NamesOfCommands(*parsed.command)));
  } else if (const auto option = UnknownOption(app)) {
    what = UnknownOptionInWords(*option, parsed);
  }
  return fmt::format("{}: {}; {} --help says more", parsed.name, what, parsed.name);
}

}  // namespace kestrel
