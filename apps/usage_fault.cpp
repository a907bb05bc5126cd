// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "usage_fault.h"

#include <algorithm>

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"

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
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments) {
  const std::vector<std::string> commands = command_names(app);
  if (arguments.empty())
    return concat("say what to do: ", joined(commands), "; `ovimap --help` explains each");
  const std::string& first = arguments.front();
  if (std::find(commands.begin(), commands.end(), first) == commands.end()) {
    if (first.starts_with('-')) return concat(error.what(), "; see `ovimap --help`");
    return concat("there is no command '", first, "', did you mean '",
                  nearest_word(first, commands), "'? `ovimap --help` lists them");
  }
  const std::vector<std::string> options = long_options(*app.get_subcommand(first));
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name == "--" || !name.starts_with("--")) continue;
    if (std::find(options.begin(), options.end(), name) == options.end())
      return concat("'", name, "' is no option of ", first, ", did you mean '",
                    nearest_word(name, options), "'? `ovimap ", first, " --help` lists them");
  }
  return concat(error.what(), "; see `ovimap ", first, " --help`");
}

}  // namespace ovimap::apps
