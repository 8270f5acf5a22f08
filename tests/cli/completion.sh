#!/bin/bash
# completion.sh KEELER SOURCE_DIR: the candidates of `keeler complete`; the scripts for bash, zsh and fish on a terminal; the
# manual pages that the build writes.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
cd "$work" || exit 1

# offers NAMES WORD... -- TYPED...: completing the typed words gives this first line, and candidates that include the words
offers() {
  local names=$1 expected=() lines word
  shift
  while [ "$1" != -- ]; do
    expected+=("$1")
    shift
  done
  shift
  accepts "complete $*" complete keeler "$@"
  mapfile -t lines <out
  [ "${lines[0]}" = "$names" ] || fail "complete $*: ${lines[0]} instead of $names"
  candidates=("${lines[@]:1}")
  candidates=("${candidates[@]%%$'\t'*}")
  for word in "${expected[@]}"; do
    [[ " ${candidates[*]} " == *" $word "* ]] || fail "complete $*: no '$word' in ${candidates[*]}"
  done
}
# only COUNT: the last call of offers had this number of candidates
only() { [ "${#candidates[@]}" -eq "$1" ] || fail "$1 expected: $(cat out)"; }

offers none render report resume -- re
only 3
offers none --theme -- render run --th
only 1
offers none dark light -- render run --theme ''
only 2
offers none --theme=dark -- render run --theme=d
only 1
offers none --width -- render run --theme dark --
[[ " ${candidates[*]} " == *" --theme "* ]] && fail "an option is offered again"
offers none --set -- run scene.toml --set time.end=1 -- # but one that may be repeated
offers none collisions.finder= -- run scene.toml --set collisions.f
offers none collisions.finder=certified -- run scene.toml --set collisions.finder=ce
only 1
offers files a-ring-wakes -- run ''
offers folders -- run a-ring-wakes -o ''
offers folders -- resume ''
offers files -- analyze run --csv ''
offers none drift gravity step light -- bench ''
only 4
offers none drift -- help bench dr
offers none certified -- bench drift --finder ''
offers none toomre_q toomre_q_without_waves -- analyze run --only toom
only 2
offers none toomre_q,optical_depth -- analyze run --only toomre_q,opt
only 1
offers none -- run scene.toml --wall-time ''
only 0
"$keeler" new --list | cut -d ' ' -f 1 >examples
offers none moonlet -- new ''
printf '%s\n' "${candidates[@]}" | diff - examples || fail "new: other examples than those of --list"
offers none -- comp
only 0

# Every command and option of --help.
runs 0 --help
commands_in out >commands
offers none -- ''
printf '%s\n' "${candidates[@]}" | sort | diff - commands || fail "other commands than those of --help"
man=$(dirname "$keeler")/man
while read -r command; do
  offers none --help -- "$command" --
  printf '%s\n' "${candidates[@]}" | sort >offered
  "$keeler" "$command" --help | grep -oE -- '^  (-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort | diff offered - ||
    fail "$command: other options than those of --help"
  # shellcheck disable=SC1003 # a backslash
  page=$(tr -d '\\' <"$man/keeler-$command.1")
  while read -r option; do
    [[ $page == *"$option"* ]] || fail "keeler-$command.1 lacks $option"
  done <offered
  # shellcheck disable=SC1003
  grep -qF "keeler-$command(1)" <(tr -d '\\' <"$man/keeler.1" | sed 's/fB//; s/fR//') || fail "keeler.1 lacks $command"
done <commands
[ "$(find "$man" -name '*.1' | wc -l)" -eq $(($(wc -l <commands) + 1)) ] || fail "pages: $(ls "$man")"
! command -v mandoc >/dev/null || mandoc -T lint -W error "$man"/*.1 || fail "the pages are no good roff"

scripts=$source_dir/src/cli/completion
PATH=$(dirname "$keeler"):$PATH
export PATH HOME=$work TERM=vt100
mkdir folder && echo >folder/part.toml

# types NAME SHELL...: completes the words in this shell
types() {
  local name=$1
  shift
  command -v "$1" >/dev/null || { echo "no $1: not tried"; return; }
  /usr/bin/python3 "$source_dir/tests/cli/completion.py" 'keeler repo\tfol\t --sna\t' 'keeler report folder/ --snapshots ' "$@" ||
    fail "$name"
  /usr/bin/python3 "$source_dir/tests/cli/completion.py" 'keeler run folder/p\t--set collisions.find\tnewton-re\t' \
    'folder/part.toml --set collisions.finder=newton-relative ' "$@" || fail "$name, with values"
}
printf 'PS1="ready> "\nbind "set enable-bracketed-paste off"\nbind "set bell-style none"\nsource /usr/share/bash-completion/bash_completion\nsource "%s/keeler.bash"\n' "$scripts" >bashrc
[ ! -e /usr/share/bash-completion/bash_completion ] || types bash bash --noprofile --rcfile bashrc -i
# shellcheck disable=SC2016 # zsh expands it
printf 'PROMPT="ready> "\nunset zle_bracketed_paste\nunsetopt prompt_sp auto_remove_slash\nfpath=("%s" $fpath)\nautoload -U compinit\ncompinit -u -D\n' "$scripts" >.zshrc
ZDOTDIR=$work types zsh zsh -i
if command -v fish >/dev/null; then
  fish --no-config -c "source '$scripts/keeler.fish'; complete -C 'keeler repo'; complete -C 'keeler report fol'
    complete -C 'keeler run x --set collisions.finder=newton-re'" >out 2>err || fail "fish: $(cat err)"
  cut -f 1 out | tr '\n' ' ' | grep -q '^report folder/ collisions.finder=newton-relative ' || fail "fish: $(cat out err)"
fi
report
