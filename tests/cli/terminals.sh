#!/bin/bash
# terminals.sh KEELER SOURCE_DIR: every command of `keeler --help`, with its progress on terminals of 40 and 120 columns and
# through a pipe (three that take seconds: on one of 40 columns): no line of progress is wider than the terminal, a pipe gets no control characters, exit codes are right;
# and the effect of -q and -v.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.1/' "$work/scene.toml"
sed '/^\[gravity\]/,/^solver/d' "$work/scene.toml" >"$work/plain.toml" # cheaper to study
printf 'scene = "%s/scene.toml"\nseeds = [1, 2]\n' "$work" >"$work/grid.toml"
runs 0 run "$work/scene.toml" -o "$work/done"

# words_for COMMAND: sets the array `words` to valid arguments of the command; false for an unknown command
words_for() {
  case $1 in
  new) words=(moonlet -o "$work/new.toml" --force) ;;
  check) words=("$work/scene.toml") ;;
  generate) words=("$work/scene.toml" -o "$work/state.hdf" --force) ;;
  tile) words=("$work/done/snap_000000.hdf" 2 1 -o "$work/tiled.hdf" --force) ;;
  run) words=("$work/scene.toml" -o "$work/run" --force) ;;
  convert) words=("$work/done" --to vtp --force) ;;
  render) words=("$work/done" --movie --width 300) ;;
  resume | info | watch | analyze | report) words=("$work/done") ;;
  bench) words=(drift --count 200 --repeats 1) ;;
  study) words=(step "$work/plain.toml" -o "$work/study" --quick --grow 0.02 --orbits 1.5) ;;
  sweep) words=("$work/grid.toml" -o "$work/sweep") ;;
  help) words=(run) ;;
  photometry) words=("$work/done" --elevation 20 --azimuth 0 --rays 1000) ;;
  occultation) words=("$work/done" --elevation 20 --azimuth "0,90" --tracks 2 --samples 4 --rays 4) ;;
  tune) words=("$work/scene.toml" --orbits 0.1) ;;
  *) return 1 ;;
  esac
}

runs 0 --help
commands_in "$work/out" >"$work/commands"
[ "$(wc -l <"$work/commands")" -ge 10 ] || fail "no commands in --help"
while read -r command; do
  [ "$command" = view ] && continue # ends by a signal: tests/python/test_view.py
  words_for "$command" || { fail "$command is not exercised: give it a line in words_for"; continue; }
  widths="40 120"
  [[ $command =~ ^(tune|study|report)$ ]] && widths=40 # seconds each; their lines are made as those of the others
  for columns in $widths; do
    rm -rf "$work/sweep" "$work/study"
    # Results are tables for a wide terminal or a file; they go to one.
    # shellcheck disable=SC2016 # that shell expands it
    /usr/bin/python3 "$source_dir/tests/cli/terminal.py" "$columns" /bin/sh -c '"$@" >"$0"' "$work/results" "$keeler" "$command" "${words[@]}" \
      >"$work/drawn" 2>"$work/err" </dev/null || fail "$command, $columns columns: $(tail -n 3 "$work/err" "$work/drawn")"
  done
  rm -rf "$work/sweep" "$work/study"
  [ "$widths" = 40 ] && continue # tune.sh, study_scene.sh and pictures.sh look at what these print elsewhere
  "$keeler" "$command" "${words[@]}" </dev/null 2>&1 | cat >"$work/piped"
  code=${PIPESTATUS[0]}
  [ "$code" -eq 0 ] || fail "$command in a pipe: $(tail -n 3 "$work/piped")"
  LC_ALL=C grep -q '[[:cntrl:]]' <(tr -d '\n' <"$work/piped") && fail "$command in a pipe: control characters"
done <"$work/commands"

for command in run generate; do
  words_for $command
  runs 0 $command "${words[@]}" --quiet
  [ -s "$work/err" ] && fail "$command --quiet says $(cat "$work/err")"
  runs 0 $command "${words[@]}" --verbose
  grep -qE "^keeler: version [0-9.]+, commit [^ ]+, .*; [0-9]+ threads?, (portable|avx2|avx512)$" "$work/err" ||
    fail "$command --verbose: no version: $(cat "$work/err")"
done
runs 0 run "$work/scene.toml" -o "$work/run" --force -v
for words in "keeler: finder certified, gravity tree" "keeler: after 0.0 s: the start" "s: the steps"; do
  grep -qF "$words" "$work/err" || fail "run -v: no '$words' in $(cat "$work/err")"
done
refuses "both" "excludes" run "$work/scene.toml" -o "$work/none" -q -v
refuses "an error in quiet" "cannot be read" run "$work/absent.toml" -o "$work/none" --quiet
report
