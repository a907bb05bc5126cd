// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "usage_fault.h"

#include <algorithm>
#include <string_view>

#include "ovimap/base/edit_distance.h"
#include "ovimap/base/error.h"
#include "ovimap/base/listed.h"

namespace ovimap::apps {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

/// ", did you mean 'WORD'?"; only where one is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const char* before = "") {
  const std::string likely = likely_word(word, known);
  return likely.empty() ? std::string(";") : concat(", did you mean '", before, likely, "'?");
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The argument that stands where one of the command's own commands should and is near to one;
/// empty when there is none.
std::string mistyped_action(const std::vector<std::string>& actions,
                            const std::vector<std::string>& arguments) {
  std::string mistyped;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (contains(actions, arguments[i])) return {};
    if (mistyped.empty() && !arguments[i].starts_with('-') &&
        !likely_word(arguments[i], actions).empty())
      mistyped = arguments[i];
  }
  return mistyped;
}

/// Where the first argument is no command.
std::string fault_before_command(const CLI::App& app, const std::string& first) {
  if (first.starts_with("--"))
    return concat("'", first, "' is no option of ovimap itself",
                  suggestion(first.substr(2), long_options(app), "--"),
                  " give a command first, see `ovimap --help`");
  return concat("there is no command '", first, "'", suggestion(first, command_names(app)),
                " `ovimap --help` lists them");
}

/// An option that the command does not have; empty when there is none.
std::string option_fault(const CLI::App& command, const std::vector<std::string>& arguments) {
  const std::vector<std::string> options = long_options(command);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name == "--" || !name.starts_with("--")) continue;
    if (!contains(options, name.substr(2)))
      return concat("'", name, "' is no option of ", command.get_name(),
                    suggestion(name.substr(2), options, "--"), " `ovimap ", command.get_name(),
                    " --help` lists them");
  }
  return {};
}

/// What the command is to do is misspelt or missing; empty when neither.
std::string action_fault(const CLI::App& command, const CLI::ParseError& error,
                         const std::vector<std::string>& arguments) {
  const std::vector<std::string> actions = command_names(command);
  const std::string& name = command.get_name();
  if (const std::string action = mistyped_action(actions, arguments); !action.empty())
    return concat("'", action, "' is nothing that ", name, " does", suggestion(action, actions),
                  " `ovimap ", name, " --help` lists it all");
  const bool chosen = std::any_of(arguments.begin(), arguments.end(), [&](const auto& argument) {
    return contains(actions, argument);
  });
  if (actions.empty() || chosen || dynamic_cast<const CLI::RequiredError*>(&error) == nullptr)
    return {};
  return concat("say what ", name, " is to do: ", listed(actions), "; `ovimap ", name,
                " --help` explains each");
}

bool writes_a_file(const CLI::App& command) {
  const std::vector<const CLI::Option*> options = command.get_options();
  return std::any_of(options.begin(), options.end(),
                     [](const auto* option) { return option->check_sname("o"); });
}

/// Arguments that nothing takes: a file to write without the -o that says so, or words without
/// quotes around them; empty when it is something else.
std::string extra_fault(const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> extra = command.remaining(true);
  if (extra.empty() || dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return {};
  const std::string& name = command.get_name();
  const std::string remedy = writes_a_file(command)
                                 ? concat("if ", name, " shall write it, say -o ", extra.front())
                                 : std::string("words that belong together stand in quotes");
  return concat("'", extra.front(), "' is one argument too many; ", remedy, "; see `ovimap ", name,
                " --help`");
}

/// What the parser says, in our words where its own are hard to read.
std::string parser_fault(const CLI::ParseError& error) {
  constexpr std::string_view kUnread = "Could not convert: ";
  const std::string said = error.what();
  if (!said.starts_with(kUnread)) return said;
  return concat(said.substr(kUnread.size()), " is no number");
}

}  // namespace

std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments) {
  const std::vector<std::string> commands = command_names(app);
  if (arguments.empty())
    return concat("say what to do: ", listed(commands), "; `ovimap --help` explains each");
  const std::string& first = arguments.front();
  if (!contains(commands, first)) return fault_before_command(app, first);
  const CLI::App& command = *app.get_subcommand(first);
  if (const std::string fault = option_fault(command, arguments); !fault.empty()) return fault;
  if (const std::string fault = action_fault(command, error, arguments); !fault.empty())
    return fault;
  if (const std::string fault = extra_fault(command, error); !fault.empty()) return fault;
  return concat(parser_fault(error), "; see `ovimap ", first, " --help`");
}

}  // namespace ovimap::apps
