#include "apps/output/shell_completion.hpp"

#include <sstream>
#include <vector>

#include "apps/apps.hpp"
#include "fom/scene/scene_table.hpp"

namespace undula::apps {
namespace {

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  const auto found = app.get_subcommands([](const CLI::App*) { return true; });
  return {found.begin(), found.end()};
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) {
    names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    names.push_back("--" + name);
  }
  return names;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

bool is_positional(const CLI::Option& option) { return option.get_positional(); }

/// What CLI::IsMember allows; empty where anything goes. It stands in the type's name, "TEXT:{a,b}".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto begin = type.find('{'), end = type.rfind('}');
  if (begin == std::string::npos || end == std::string::npos) {
    return {};
  }
  std::vector<std::string> choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(list, choice, ',');) {
    choices.push_back(choice);
  }
  return choices;
}

/// An override of a scene's key.
bool sets_a_key(const CLI::Option& option) { return option.get_type_name() == "KEY=VALUE"; }

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : between) + word;
  }
  return text;
}

/// Keys of scenes for --set; those of named entries depend on the scene.
std::string keys_for_set() {
  std::vector<std::string> keys;
  for (const SceneKey& key : scene_table()) {
    keys.push_back(key.path + "=");
  }
  return joined(keys);
}

/// In single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

/// A case of `command` in bash: which options there are, and what follows each.
std::string bash_case(const CLI::App& command, const std::string& name) {
  std::vector<std::string> options, with_value, with_key, choices;
  std::string values;
  for (const CLI::Option* option : command.get_options()) {
    const auto names = names_of(*option);
    options.insert(options.end(), names.begin(), names.end());
    const auto members = choices_of(*option);
    if (is_positional(*option)) {
      choices.insert(choices.end(), members.begin(), members.end());
    } else if (sets_a_key(*option)) {
      with_key.insert(with_key.end(), names.begin(), names.end());
    } else if (takes_value(*option)) {
      with_value.insert(with_value.end(), names.begin(), names.end());
    }
  }
  return "    " + (name.empty() ? "''" : name) + ")\n      options=" + quoted(joined(options)) +
         "\n      with_value=" + quoted(joined(with_value)) + "\n      with_key=" + quoted(joined(with_key)) +
         "\n      words=" + quoted(joined(choices)) + "\n      ;;\n";
}

/// Characters that the specifications of _arguments give a meaning.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result;
}

std::string zsh_action(const CLI::Option& option) {
  const auto choices = choices_of(option);
  if (!choices.empty()) {
    return "(" + joined(choices) + ")";
  }
  return sets_a_key(option) ? "_undula_keys" : "_files";
}

/// The specifications of _arguments for every option of a command.
std::string zsh_arguments(const CLI::App& command) {
  std::string specifications;
  int place = 1;
  for (const CLI::Option* option : command.get_options()) {
    const bool repeated = option->get_expected_max() > 1;
    std::vector<std::string> found;
    if (is_positional(*option)) {
      found.push_back((repeated ? "*" : std::to_string(place++)) + ":" + escaped(option->get_description()) +
                      ":" + zsh_action(*option));
    }
    for (const std::string& name : names_of(*option)) {
      found.push_back(
          (repeated ? "*" : "") + name + "[" + escaped(option->get_description()) + "]" +
          (takes_value(*option) ? ":" + escaped(option->get_type_name()) + ":" + zsh_action(*option) : ""));
    }
    for (const std::string& specification : found) {
      specifications += " \\\n        " + quoted(specification);
    }
  }
  return specifications;
}

} // namespace

std::string bash_completion(const CLI::App& app) {
  std::string cases = bash_case(app, "");
  std::vector<std::string> commands;
  for (const CLI::App* command : subcommands(app)) {
    commands.push_back(command->get_name());
    cases += bash_case(*command, command->get_name());
  }
  return "# Completion of undula in bash, printed by `undula completion bash`.\n"
         "_undula() {\n"
         "  local word=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD - 1]}\" command='' i\n"
         "  local options='' with_value='' with_key='' words=''\n"
         "  COMPREPLY=()\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    if [[ ${COMP_WORDS[i]} != -* ]]; then\n"
         "      command=\"${COMP_WORDS[i]}\"\n"
         "      break\n"
         "    fi\n"
         "  done\n"
         "  case \"$command\" in\n" +
         cases +
         "  esac\n"
         "  [[ -z $command ]] && words=" +
         quoted(joined(commands)) +
         "\n"
         "  if [[ \" $with_key \" == *\" $before \"* ]]; then\n"
         "    COMPREPLY=($(compgen -W " +
         quoted(keys_for_set()) +
         " -- \"$word\"))\n"
         "    compopt -o nospace 2>/dev/null\n"
         "  elif [[ \" $with_value \" == *\" $before \"* ]]; then\n"
         "    : # a file, or what only the user knows\n"
         "  elif [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _undula undula\n";
}

std::string zsh_completion(const CLI::App& app) {
  std::string descriptions, cases;
  for (const CLI::App* command : subcommands(app)) {
    descriptions += "\n    " + quoted(escaped(command->get_name()) + ":" + command->get_description());
    cases += "    " + command->get_name() + ")\n      _arguments" + zsh_arguments(*command) + "\n      ;;\n";
  }
  return "#compdef undula\n"
         "# Completion of undula in zsh, printed by `undula completion zsh`.\n"
         "_undula_keys() {\n"
         "  compadd -S '' -- " +
         keys_for_set() +
         "\n"
         "}\n"
         "_undula() {\n"
         "  local curcontext=\"$curcontext\" state line\n"
         "  local -a commands\n"
         "  commands=(" +
         descriptions +
         "\n  )\n"
         "  _arguments -C" +
         zsh_arguments(app) +
         " \\\n        '1:command:->command' '*::argument:->argument'\n"
         "  case \"$state\" in\n"
         "  command) _describe -t commands 'command of undula' commands ;;\n"
         "  argument)\n"
         "    case \"${words[1]}\" in\n" +
         cases +
         "    esac\n"
         "    ;;\n"
         "  esac\n"
         "}\n"
         "if [[ \"${funcstack[1]}\" == _undula ]]; then\n"
         "  _undula \"$@\"\n"
         "else\n"
         "  compdef _undula undula\n"
         "fi\n";
}

} // namespace undula::apps
