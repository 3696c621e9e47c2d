# Completion of polemcl's programs for bash: subcommands, options, words that options allow, files,
# folders, and the names of installed settings, as the programs tell them with --help.

# What a command takes, by its words: `build --input:FILE... --per:pose|metre before:FILE`. The kind of a
# value is FILE, FOLDER, INI, words with a bar between them, or ANY.
declare -gA _polemcl_words=()

# _polemcl_ask COMMAND...: asks a command once in a shell.
_polemcl_ask() {
  [[ -n ${_polemcl_words[$*]-} ]] || _polemcl_words[$*]=$("$@" --help 2>/dev/null | awk '
    /^[A-Z].*:/ { section = $1 }
    /^  [^ ]/ && section == "Subcommands:" { print $1 }
    /^  [^ ]/ && (section == "Options:" || section == "Arguments:") {
      sub(/^  (-h, )?/, "")
      sub(/  .*/, "")
      kind = $2
      if (kind !~ /^(FILE|FOLDER|INI)(\.\.\.)?$/ && kind !~ /\|/) kind = "ANY"
      print $1 (NF > 1 ? ":" kind : "")
    }')
}

# _polemcl_values KIND CURRENT PROGRAM: offers what may stand for a value.
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
  local command= taken words=() argument=
  COMPREPLY=()
  _polemcl_ask "$program"
  for ((i = 1; i < COMP_CWORD; ++i)); do
    entry=${COMP_WORDS[i]}
    [[ $entry == = ]] && continue # of --option=value
    since=$((since + 1))
    if [[ $entry == -* ]]; then
      option=$entry since=0
    elif [[ -z $command && $'\n'${_polemcl_words[$program]}$'\n' == *$'\n'"$entry"$'\n'* ]]; then
      command=$entry
    fi
  done
  [[ $current == = ]] && current=
  taken=${_polemcl_words[$program]}
  if [[ -n $command ]]; then # with the options of all subcommands, without subcommands
    _polemcl_ask "$program" "$command"
    taken=$(grep '^--' <<<"$taken")$'\n'${_polemcl_words[$program $command]}
  fi
  for entry in $taken; do
    [[ ${entry%%:*} == "$option" && $entry == *:* ]] && kind=${entry#*:}
    [[ $entry == *:* && $entry != -* ]] && argument=${entry#*:}
    [[ $entry == -* || $entry != *:* ]] && words+=("${entry%%:*}")
  done
  if [[ $current != -* && -n $kind && ($since == 0 || $kind == *...) ]]; then
    _polemcl_values "${kind%...}" "$current" "$program"
  elif [[ $current != -* && -n $argument ]]; then
    _polemcl_values "${argument%...}" "$current" "$program"
  else
    COMPREPLY=($(compgen -W "${words[*]}" -- "$current"))
  fi
}

complete -F _polemcl pole-import pole-extract pole-map pole-localize pole-eval pole-simulate pole-batch \
  pole-labels
