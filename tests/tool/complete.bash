#!/usr/bin/env bash
# complete.bash COMPLETION TOOL LINE: what the completion offers where the cursor stands at the end of LINE,
# one a line; and before that, "-o NAME" for each option of compopt that it set.
set -u
source "$1"
tool=$2 line=$3

# Splits as readline does at blanks and in front of and behind : and =, each of which is a word.
COMP_WORDS=()
word= started=
flush() { if [[ $started ]]; then COMP_WORDS+=("$word"); fi; word= started=; }
for ((i = 0; i < ${#line}; ++i)); do
  c=${line:i:1}
  case $c in
    ' ') flush ;;
    : | =) flush; COMP_WORDS+=("$c") ;;
    *) word+=$c started=1 ;;
  esac
done
if [[ $started || $line == *' ' ]]; then COMP_WORDS+=("$word"); fi
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
COMP_LINE=$line
COMP_POINT=${#line}
COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'

compopt() { printf '%s\n' "$*"; }
[[ $(complete -p plumb) == 'complete -F _plumb plumb' ]] || exit 3
_plumb "$tool" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
((${#COMPREPLY[@]} == 0)) || printf '%s\n' "${COMPREPLY[@]}"
