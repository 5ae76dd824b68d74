# Completion of plumb's command line for bash. What there is to choose from is what the tool's own --help
# lists, so it is never out of date. Installed as share/bash-completion/completions/plumb; needs nothing of
# the package bash-completion but that it loads the file, which "source" does as well.

# The words up to the cursor, into the array `words`: bash splits them at : and = too.
_plumb_words() {
  local line=${COMP_LINE:0:COMP_POINT} word i
  words=()
  for ((i = 0; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if ((i == 0)) || [[ $line == [[:blank:]]* ]]; then
      words+=('')
      line=${line#"${line%%[![:blank:]]*}"}
    fi
    ((${#word} <= ${#line})) || word=$line
    words[-1]+=$word
    line=${line#"$word"}
  done
}

# The indented lines of the help under a heading that begins with the argument, up to one that is not, each
# cut at its first colon or blank.
_plumb_listed() {
  local line within=
  while IFS= read -r line; do
    if [[ $within && $line != ' '* ]]; then return; fi
    if [[ $within && $line =~ ^'  '([^ :]+) ]]; then printf '%s\n' "${BASH_REMATCH[1]}"; fi
    if [[ $line == "$1"* ]]; then within=1; fi
  done <<<"$help"
}

# The options of the help, one a line; of each the placeholder of its value, if it takes one.
_plumb_options() {
  local line
  while IFS= read -r line; do
    if [[ $line =~ ^'  '(-h,)?(--[a-z-]+)(' '([^ =]+))? ]]; then
      printf '%s %s\n' "${BASH_REMATCH[2]}" "${BASH_REMATCH[4]}"
    fi
  done <<<"$help"
}

# What stands for the value of an option: nothing for a flag.
_plumb_value_of() {
  local option value
  while read -r option value; do
    if [[ $option == "$1" ]]; then printf '%s' "$value"; fi
  done < <(_plumb_options)
}

_plumb_reply_words() { mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$cur"); }

# One more item of a list with commas, none twice.
_plumb_reply_list() {
  local item done=
  if [[ $cur == *,* ]]; then done=${cur%,*},; fi
  for item in $1; do
    if [[ ,$done != *,$item,* && $done$item == "$cur"* ]]; then COMPREPLY+=("$done$item"); fi
  done
  compopt -o nospace 2>/dev/null
}

# Files whose names end as the arguments say, in any case, and folders.
_plumb_reply_files() {
  local file ending found=
  while IFS= read -r file; do
    for ending in "$@"; do
      if [[ -d $file || ${file,,} == *".$ending" ]]; then
        COMPREPLY+=("$file")
        found=1
        break
      fi
    done
  done < <(compgen -f -- "$cur")
  if [[ $found ]]; then compopt -o filenames 2>/dev/null; fi
}

_plumb_reply_scene() {
  if [[ $cur == builtin:* ]]; then
    local name names= help
    help=$("$tool" info --help 2>/dev/null)  # which lists them
    for name in $(_plumb_listed 'Built-in scenes'); do names+=" builtin:$name"; done
    _plumb_reply_words "$names"
    return
  fi
  _plumb_reply_files ply obj stl off
  if [[ builtin: == "$cur"* ]]; then
    COMPREPLY+=('builtin:')
    compopt -o nospace 2>/dev/null
  fi
}

# The value of option $1, whose placeholder is $2.
_plumb_reply_value() {
  case $1 in
    --methods) _plumb_reply_list "$(_plumb_listed 'Methods:')" ;;
    --method) _plumb_reply_words "$(_plumb_listed 'Methods:')" ;;
    --cases) _plumb_reply_list "$(_plumb_listed 'Hard cases:')" ;;
    --size) _plumb_reply_words '640x360 1280x720 1920x1080 3840x2160' ;;
    --simd)
      local sets=${help#*Instruction sets of this machine*$'\n'}
      sets="auto ${sets%%$'\n'*}"
      if [[ $help == *', or all'* ]]; then sets+=' all'; fi
      _plumb_reply_words "$sets"
      ;;
    *)
      case $2 in
        DIR) mapfile -t COMPREPLY < <(compgen -d -- "$cur") && compopt -o filenames 2>/dev/null ;;
        FILE.*) _plumb_reply_files "${2#FILE.}" ;;
        *'|'*) _plumb_reply_words "${2//|/ }" ;;
      esac
      ;;
  esac
}

# Whether a SCENE may stand at the cursor: there is none yet, or the subcommand takes several.
_plumb_takes_scene() {
  local i
  if [[ $help != *$'\n  SCENE '* ]]; then return 1; fi
  if [[ $help == *$'\n  SCENE TEXT ... '* ]]; then return 0; fi
  for ((i = 2; i < ${#words[@]} - 1; ++i)); do
    if [[ ${words[i]} != -* ]]; then return 1; fi
    if [[ ${words[i]} != *=* && $(_plumb_value_of "${words[i]}") ]]; then ((++i)); fi
  done
  return 0
}

_plumb() {
  local words help cur option value= prefix= tool=${1/#\~\//$HOME/}
  COMPREPLY=()
  _plumb_words
  cur=${words[-1]}
  if ((${#words[@]} == 2)); then
    help=$("$tool" --help 2>/dev/null)
    if [[ $cur == -* ]]; then
      _plumb_reply_words "$(_plumb_options | cut -d ' ' -f 1)"
    else
      _plumb_reply_words "$(_plumb_listed Subcommands:)"
    fi
    return
  fi
  help=$("$tool" "${words[1]}" --help 2>/dev/null)
  if [[ $help != *"Usage: plumb ${words[1]} "* ]]; then return; fi
  option=${words[-2]}
  if [[ $cur == --*=* ]]; then
    option=${cur%%=*}
    prefix=$option=
    cur=${cur#*=}
  fi
  if [[ $option == --* && $option != *=* ]]; then value=$(_plumb_value_of "$option"); fi
  if [[ $value ]]; then
    _plumb_reply_value "$option" "$value"
  elif [[ ! $prefix && $cur != -* ]] && _plumb_takes_scene; then
    _plumb_reply_scene
  elif [[ ! $prefix ]]; then
    _plumb_reply_words "$(_plumb_options | cut -d ' ' -f 1)"
  fi
  # Only what follows the last : or = is replaced, where bash splits words there.
  local breaks=${COMP_WORDBREAKS//[!:=]/} whole=$prefix$cur
  local replaced=$whole
  if [[ $breaks ]]; then replaced=${whole##*["$breaks"]}; fi
  COMPREPLY=("${COMPREPLY[@]/#/$prefix}")
  COMPREPLY=("${COMPREPLY[@]#"${whole%"$replaced"}"}")
}

complete -F _plumb plumb
