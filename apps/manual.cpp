// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "ovimap/base/error.h"
#include "ovimap/base/version.h"
#include "ovimap/image/codec.h"
#include "program.h"

namespace ovimap::apps {

namespace {

namespace fs = std::filesystem;
using Commands = std::vector<const CLI::App*>;

Commands commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  write_text(file, text);
}

// ---------------------------------------------------------------------------------- man pages

/// Text as roff reads it.
std::string roff(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_line = i == 0 || text[i - 1] == '\n';
    if (begins_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\')
      out += "\\e";
    else if (text[i] == '-')
      out += "\\-";
    else
      out += text[i];
  }
  return out;
}

std::string option_entry(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return concat(".TP\n\\fB", roff(option.get_name(option.get_positional(), true)), "\\fR",
                type.empty() || option.get_items_expected_max() == 0 ? "" : " " + roff(type), "\n",
                roff(option.get_description()), "\n");
}

std::string options_section(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) text += option_entry(*option);
  return text.empty() ? "" : ".SH OPTIONS\n" + text;
}

std::string commands_section(const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : commands_of(app))
    text +=
        concat(".TP\n\\fB", command->get_name(), "\\fR\n", roff(command->get_description()), "\n",
               app.get_parent() ? "" : concat("See ovimap\\-", command->get_name(), "(1).\n"));
  return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

/// man(7) of a command, or of the program.
std::string man_page(const CLI::App& command, const std::string& name) {
  std::string usage = name;
  std::replace(usage.begin(), usage.end(), '-', ' ');
  const std::string footer = command.get_footer();
  return concat(".TH ", name, " 1 \"\" \"ovimap ", version(), "\"\n.SH NAME\n", roff(name), " \\- ",
                roff(command.get_description()), "\n.SH SYNOPSIS\n\\fB", usage,
                "\\fR [OPTIONS] ...\n", commands_section(command), options_section(command),
                footer.empty() ? "" : ".SH EXAMPLE\n.nf\n" + roff(footer) + "\n.fi\n",
                ".SH EXIT STATUS\n0: done; 1: ran, but the answer is no; 2: the message says what "
                "to mend; 3: a defect of ovimap.\n");
}

// -------------------------------------------------------------------------------- completions

/// Long options and what the command can do, separated by spaces.
std::string words_of(const CLI::App& command) {
  std::string words;
  for (const CLI::App* action : commands_of(command)) words += action->get_name() + " ";
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  return words;
}

std::string bash_completion(const CLI::App& app) {
  std::string names, cases;
  for (const CLI::App* command : commands_of(app)) {
    names += command->get_name() + " ";
    cases += concat("    ", command->get_name(), ") words=\"", words_of(*command), "\" ;;\n");
  }
  return concat("_ovimap() {\n  local words=\"\"\n  case \"${COMP_WORDS[1]}\" in\n", cases,
                "  esac\n  [ \"$COMP_CWORD\" != 1 ] || words=\"", names,
                "--help --version\"\n  COMPREPLY=($(compgen -W \"$words\" -- \"$2\"))\n}\n"
                "complete -o default -F _ovimap ovimap\n");
}

std::string zsh_completion(const CLI::App& app) {
  return "#compdef ovimap\nautoload -U +X bashcompinit && bashcompinit\n" + bash_completion(app);
}

std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

std::string fish_completion(const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : commands_of(app)) {
    const std::string& name = command->get_name();
    text += concat("complete -c ovimap -n __fish_use_subcommand -f -a ", name, " -d ",
                   fish_quoted(command->get_description()), "\n");
    for (const CLI::Option* option : command->get_options())
      for (const std::string& option_name : option->get_lnames())
        text += concat("complete -c ovimap -n '__fish_seen_subcommand_from ", name, "' -l ",
                       option_name, " -d ", fish_quoted(option->get_description()), "\n");
  }
  return text;
}

int write_manual(const fs::path& share) {
  const Program program;
  const CLI::App& app = program.app();
  const fs::path man = share / "man/man1";
  write(man / "ovimap.1", man_page(app, "ovimap"));
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = "ovimap-" + command->get_name();
    write(man / (name + ".1"), man_page(*command, name));
  }
  write(share / "bash-completion/completions/ovimap", bash_completion(app));
  write(share / "zsh/site-functions/_ovimap", zsh_completion(app));
  write(share / "fish/vendor_completions.d/ovimap.fish", fish_completion(app));
  std::printf("man pages and completions of bash, zsh and fish are in %s\n", share.c_str());
  return kDone;
}

}  // namespace

Action add_manual(CLI::App& command) {
  auto share = std::make_shared<fs::path>();
  command
      .add_option("FOLDER", *share,
                  "where such things are looked for, as ~/.local/share or /usr/local/share")
      ->required();
  return [share] { return write_manual(*share); };
}

}  // namespace ovimap::apps
