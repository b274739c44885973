// The command `fovea completion`: scripts with which shells complete commands, options, and names of graphs and passes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "fovea/scenes.h"
#include "samples/fovea/arguments.h"
#include "samples/fovea/commands.h"

namespace fovea::cli {
namespace {

// What a word can be at a place of the command line.
struct Completed {
  std::string command;                      // "scene info"
  std::string doc;                          // its first line
  std::string subcommands;                  // "info export", one of which has to follow; or ""
  std::vector<const CLI::Option*> options;  // with two dashes
  std::string words;                        // shell command that lists what its arguments may be, or ""
};

// Whether a file, too, can be the value of an option.
bool takesFiles(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.find('{') == std::string::npos && type.find('|') == std::string::npos;
}

// "text dot json" of an option that takes one of these: its type is FORMAT:{text,dot,json} or diffuse|full. Of a scene,
// the names of those that come along.
std::string choicesOf(const CLI::Option& option) {
  if (option.get_lnames()[0] == "scene") return fmt::format("{}", fmt::join(scene::names(), " "));
  std::string type = option.get_type_name();
  const size_t brace = type.find('{');
  if (brace != std::string::npos)
    type = type.substr(brace + 1, type.find('}') - brace - 1);
  else if (type.find('|') == std::string::npos)
    return {};
  std::ranges::replace(type, ',', ' ');
  std::ranges::replace(type, '|', ' ');
  return type;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string onOneLine(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string wordsOf(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (name == "GRAPH" || name == "BEFORE") return "fovea graphs";
    if (name == "TYPE") return "fovea passes";
  }
  return {};
}

void collect(const CLI::App& command, const std::string& prefix, std::vector<Completed>& all) {
  for (const CLI::App* sub : command.get_subcommands(nullptr)) {
    const std::string name = prefix.empty() ? sub->get_name() : prefix + " " + sub->get_name();
    Completed& made = all.emplace_back();
    made.command = name;
    made.doc = firstLine(sub->get_description());
    made.words = wordsOf(*sub);
    if (sub->get_require_subcommand_min() > 0)
      for (const CLI::App* next : sub->get_subcommands(nullptr))
        made.subcommands += (made.subcommands.empty() ? "" : " ") + next->get_name();
    for (const CLI::Option* option : sub->get_options())
      if (!option->get_lnames().empty()) made.options.push_back(option);
    collect(*sub, name, all);
  }
}

// Single quotes of a shell, in which nothing but themselves means anything.
std::string quoted(std::string text) {
  for (size_t at = text.find('\''); at != std::string::npos; at = text.find('\'', at + 4))
    text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::string bashScript(const std::vector<Completed>& all) {
  std::string cases, values;
  for (const Completed& c : all) {
    std::vector<std::string> words;
    for (const CLI::Option* option : c.options) words.push_back("--" + option->get_lnames()[0]);
    for (const Completed& sub : all)
      if (sub.command.starts_with(c.command + " ")) words.push_back(sub.command.substr(c.command.size() + 1));
    cases += fmt::format("    {}) words={}; names={}; files={} ;;\n", quoted(c.command),
                         quoted(fmt::format("{}", fmt::join(words, " "))), quoted(c.words),
                         c.subcommands.empty() ? "-f" : "");
    for (const CLI::Option* option : c.options)
      if (takesValue(*option))
        values += fmt::format("    {}) COMPREPLY=($(compgen -W {} {} -- \"$word\")); return ;;\n",
                              quoted(c.command + " --" + option->get_lnames()[0]), quoted(choicesOf(*option)),
                              takesFiles(*option) ? "-f" : "");
  }
  std::vector<std::string> commands;
  for (const Completed& c : all)
    if (c.command.find(' ') == std::string::npos) commands.push_back(c.command);
  return fmt::format(R"sh(# Completion of fovea for bash: source <(fovea completion bash)
_fovea() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= words= names= files= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${{COMP_WORDS[i]}}" in
      ' '[a-z]*|'scene '[a-z]*|'bench '[a-z]*|'new '[a-z]*) command="${{command:+$command }}${{COMP_WORDS[i]}}" ;;
      *) break ;;
    esac
  done
  case "$command $before" in
{}  esac
  case $command in
    '') words={} ;;
{}  esac
  if [[ $word != -* && -n $names ]]; then
    words="$words $($names 2>/dev/null | cut -d' ' -f1)"
  fi
  [[ $word == -* || -z $files ]] || COMPREPLY=($(compgen -f -- "$word"))
  COMPREPLY+=($(compgen -W "$words" -- "$word"))
}}
complete -o filenames -F _fovea fovea
)sh",
                     values, quoted(fmt::format("{}", fmt::join(commands, " "))), cases);
}

std::string fishScript(const std::vector<Completed>& all) {
  std::string text = "# Completion of fovea for fish: fovea completion fish | source\n";
  for (const Completed& c : all) {
    const size_t space = c.command.rfind(' ');
    const std::string own = space == std::string::npos ? c.command : c.command.substr(space + 1);
    const std::string parent = space == std::string::npos ? std::string() : c.command.substr(0, space);
    text += fmt::format(
        "complete -c fovea -n {} -a {} -d {}\n",
        quoted(parent.empty() ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + parent), own,
        quoted(c.doc));
    const std::string here = quoted("__fish_seen_subcommand_from " + own);
    if (!c.subcommands.empty())
      text += fmt::format(
          "complete -c fovea -n {} -f\n",
          quoted(fmt::format("__fish_seen_subcommand_from {}; and not __fish_seen_subcommand_from {}", own,
                             c.subcommands)));
    for (const CLI::Option* option : c.options)
      text += fmt::format("complete -c fovea -n {} -l {} -d {}{}{}\n", here, option->get_lnames()[0],
                          quoted(onOneLine(option->get_description())), takesValue(*option) ? " -r" : "",
                          (takesFiles(*option) ? "" : " -f") +
                              (choicesOf(*option).empty() ? "" : " -a " + quoted(choicesOf(*option))));
    if (!c.words.empty())
      text += fmt::format("complete -c fovea -n {} -a {}\n", here,
                          quoted(fmt::format("({} 2>/dev/null | string split -f1 ' ')", c.words)));
  }
  return text;
}

}  // namespace

void addCompletion(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "completion", "Print a script with which a shell completes commands and options");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->type_name("")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([&program, shell, &action] {
    std::vector<Completed> all;
    collect(program, {}, all);
    std::string text = *shell == "fish" ? fishScript(all) : bashScript(all);
    // zsh runs the script of bash.
    if (*shell == "zsh") text = "autoload -U +X compinit bashcompinit && compinit && bashcompinit\n" + text;
    action = [text] {
      fmt::print("{}", text);
      return ExitCode::Ok;
    };
  });
}

}  // namespace fovea::cli
