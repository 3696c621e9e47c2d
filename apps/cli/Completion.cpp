#include "cli/Completion.h"

#include "cli/OptionText.h"

namespace polemcl::apps {
namespace {

/// What stands for a value: FILE, FOLDER, INI, words with a bar between them, or ANY.
std::string kindOf(const OptionText& option) {
  const bool known = option.value == "FILE" || option.value == "FOLDER" || option.value == "INI" ||
                     !option.choices.empty();
  return (known ? option.value : "ANY") + (option.many ? "..." : "");
}

constexpr const char* s_completionBegin =
    R"(# Completion of polemcl's programs for bash. Written by the build from their options.

# What a program, or a program with a subcommand, takes: options and arguments with the kind of
# their value behind a colon (FILE, FOLDER, INI, a|b|c, ANY; ... for several), and subcommands.
_polemcl_options() {
  case $1 in
)";

constexpr const char* s_completionEnd = R"(  esac
}

# Words for a value of a kind, seen from the program.
_polemcl_values() {
  local kind=$1 current=$2 program=$3 folder names=()
  case $kind in
    FILE) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
    FOLDER) mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
    INI)
      mapfile -t COMPREPLY < <(compgen -d -- "$current"; compgen -f -X '!*.ini' -- "$current")
      folder=$(type -P "$program")
      folder=${folder%/*}/../share/polemcl/config
      [[ -d $folder ]] && mapfile -t names < <(cd "$folder" && printf '%s\n' *.ini */*.ini)
      COMPREPLY+=($(compgen -W "${names[*]}" -- "$current"))
      ;;
    ANY) ;;
    *) COMPREPLY=($(compgen -W "${kind//|/ }" -- "$current")) ;;
  esac
  [[ $kind == F* || $kind == INI ]] && compopt -o filenames 2>/dev/null
  return 0
}

_polemcl() {
  local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} i entry option= since=0 kind=
  local command=${program##*/} words=() arguments=
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    entry=${COMP_WORDS[i]}
    [[ $entry == = ]] && continue # of --option=value
    since=$((since + 1))
    if [[ $entry == -* ]]; then
      option=$entry since=0
    elif [[ $command != *' '* && " $(_polemcl_options "$command") " == *" $entry "* ]]; then
      command+=" $entry"
    fi
  done
  [[ $current == = ]] && current=
  for entry in $(_polemcl_options "$command"); do
    [[ ${entry%%:*} == "$option" && $entry == *:* ]] && kind=${entry#*:}
    [[ $entry == *:* && $entry != -* ]] && arguments=${entry#*:}
    [[ $entry == -* || $entry != *:* ]] && words+=("${entry%%:*}")
  done
  if [[ $current != -* && -n $kind && ($since == 0 || $kind == *...) ]]; then
    _polemcl_values "${kind%...}" "$current" "$program"
  elif [[ $current != -* && -n $arguments ]]; then
    _polemcl_values "${arguments%...}" "$current" "$program"
  else
    COMPREPLY=($(compgen -W "${words[*]}" -- "$current"))
  fi
}
)";

}  // namespace

std::string completionRow(const CLI::App& app, const std::string& name) {
  std::string row;
  for (const CLI::App* command : subcommandsOf(app)) row += command->get_name() + ' ';
  std::vector<OptionText> options = optionsOf(app, false);
  for (const OptionText& shared : sharedOptions(app)) options.push_back(shared);
  for (const OptionText& argument : optionsOf(app, true)) options.push_back(argument);
  for (const OptionText& option : options)
    row += option.names.back() + (option.value.empty() ? "" : ':' + kindOf(option)) + ' ';
  row.pop_back();
  return "    '" + name + "') echo '" + row + "' ;;\n";
}

std::string completion(const std::vector<std::string>& programs, const std::string& rows) {
  std::string end = "\ncomplete -F _polemcl";
  for (const std::string& program : programs) end += ' ' + program;
  return s_completionBegin + rows + s_completionEnd + end + '\n';
}

}  // namespace polemcl::apps
