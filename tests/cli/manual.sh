#!/bin/bash
# manual.sh KEELER SOURCE_DIR: help, README and manual list the same commands; the manual has every option, exit code and
# JSON name.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
manual=$source_dir/docs/manual/commands.md

accepts "help" --help
commands_in "$work/out" >"$work/commands"
[ "$(wc -l <"$work/commands")" -ge 7 ] || fail "help: no commands in: $(cat "$work/out")"
# shellcheck disable=SC2016 # backquotes of Markdown
sed -nE 's/^\| `keeler ([a-z]+).*/\1/p' "$source_dir/README.md" | sort | diff "$work/commands" - ||
  fail "the README has other commands than --help"
sed -nE 's/^## keeler ([a-z]+)$/\1/p' "$manual" | sort | diff "$work/commands" - ||
  fail "the manual has other commands than --help"

# read_section COMMAND: sets $section to the manual's section about it
read_section() { section=$(sed -n "/^## keeler $1\$/,/^## /p" "$manual"); }

# has_option OPTION: the section has it, and not as the begin of a longer one
has_option() { [[ $section =~ $1([^a-z-]|$) ]]; }

# examples_are_understood NAME HELP: the program refuses only the option that is appended to each example
examples_are_understood() {
  local example words count=0
  while read -r example; do
    read -ra words <<<"${example#keeler }"
    refuses "an example of $1: $example" "has no option '--absent'" "${words[@]}" --absent
    count=$((count + 1))
  done < <(sed -nE 's/^  (keeler .*)/\1/p' "$2")
  [ "$count" -ge 1 ] || fail "$1 --help has no example"
}

while read -r command; do
  read_section "$command"
  accepts "help of $command" "$command" --help
  prints "help of $command" "keeler $command"
  cp "$work/out" "$work/help"
  commands_in "$work/help" >"$work/parts"
  while read -r part; do # keeler bench drift, ...
    accepts "help of $command $part" "$command" "$part" --help
    prints "help of $command $part" "keeler $command $part"
    [[ $section == *"keeler $command $part"* ]] || fail "the manual does not have $command $part"
    cat "$work/out" >>"$work/help"
  done <"$work/parts"
  examples_are_understood "$command" "$work/help"
  sed -i '/^  keeler /d' "$work/help"
  grep -oE -- '--[a-z][a-z-]*' "$work/help" | sort -u | grep -v -- '^--help$' >"$work/options"
  while read -r option; do
    has_option "$option" || fail "the manual does not have $command $option"
  done <"$work/options"
  grep -oE -- '--[a-z][a-z-]*' <<<"$section" | sort -u | comm -23 - "$work/options" >"$work/unknown"
  [ -s "$work/unknown" ] && fail "the manual is ahead: $command has no $(cat "$work/unknown")"
done <"$work/commands"

# names COMMAND: every name in the two upper levels of the printed JSON is in the manual's section
names() {
  local name
  read_section "$1"
  while read -r name; do
    [[ $section =~ [\`.]${name}[\`.] ]] || fail "the manual does not have the name $name of $1"
  done < <(sed -nE 's/^ {2,4}"([a-z_0-9]+)":.*/\1/p' "$work/out" | sort -u)
}
# explained: every name in the printed JSON, except of a scatter, is in the page on numbers
explained() {
  local name content
  content "$source_dir/docs/manual/numbers.md" || fail "a NUL in the manual"
  while read -r name; do
    [[ $content =~ [\`.]${name}\` ]] || fail "no explanation of the number $name"
  done < <(sed -nE 's/^ +"([a-z_0-9]+)":.*/\1/p' "$work/out" | sed 's/_scatter//' | sort -u)
}
runs 0 bench drift --count 200 --repeats 1 --json
names bench
runs 0 bench gravity --count 200 --state uniform --solver tree --repeats 1 --json
sed -i 's/^      "/    "/' "$work/out" # of its rows
names bench
runs 0 bench step --count 200 --state uniform --repeats 1 --json
names bench
if "$keeler" bench light --count 2400 --state uniform --repeats 1 --json >"$work/out" 2>/dev/null; then # with Embree
  names bench
fi
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.004 --json
names run
printf 'scene = "scene.toml"\n[set]\n"time.end" = 0.004\n' >"$work/grid.toml"
runs 0 sweep "$work/grid.toml" -o "$work/sweep" --json
names sweep
accepts "check" check "$work/scene.toml" --json
names check
accepts "analyze" analyze "$work/run" --json
explained
accepts "lines of sight" analyze "$work/run" --json --elevation 5,30 --azimuth 0,90 --rays 1000
explained
accepts "info" info "$(newest_checkpoint "$work/run")" --json
sed -i '/^  "fields"/,/^  }/{/^    /d}; /^  "attributes"/,/^  }/{/^    /d}' "$work/out" # names of the file, not of the program
names info
accepts "info of a folder" info "$work/run" --json
names info

report
