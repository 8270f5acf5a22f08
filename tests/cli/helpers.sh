#!/bin/bash
# Functions of the tests that run the program. Usage: source it with KEELER and SOURCE_DIR, end with `report`.
# shellcheck disable=SC2034 # used by the tests
set -u
keeler=$1
source_dir=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

report() {
  echo "$failures failures"
  [ "$failures" -eq 0 ]
}

# runs CODE ARGUMENT...: the program ends with this code; its output is in $work/out and $work/err
runs() {
  local expected=$1 code=0
  shift
  "$keeler" "$@" >"$work/out" 2>"$work/err" || code=$?
  [ "$code" -eq "$expected" ] || fail "$*: exit $code instead of $expected: $(tail -n 3 "$work/err")"
}

# accepts NAME ARGUMENT...: the program ends with code 0 and prints nothing on stderr
accepts() {
  local name=$1
  shift
  runs 0 "$@"
  [ -s "$work/err" ] && fail "$name: $(cat "$work/err")"
}

# content FILE: sets $content to the text of the file, without a process of its own; fails if it holds a NUL
content() { ! IFS= LC_ALL=C read -r -d '' content <"$1"; }

# prints NAME WORDS: the last command printed the words
prints() {
  local content
  content "$work/out" || fail "$1: a NUL on stdout"
  [[ $content == *"$2"* ]] || fail "$1: no '$2' in: $content"
}

# no_controls NAME: the last command printed no control characters
no_controls() {
  LC_ALL=C grep -q '[[:cntrl:]]' <(cat "$work/out" "$work/err" | tr -d '\n') && fail "$1: control characters"
  return 0
}

# one_line NAME WORDS: the last command printed exactly one message, besides progress and notes, and it contains the words
one_line() {
  local line said=() besides='^[0-9.]+/[0-9.]+ orbits | % +[0-9:]+ left  |^ *[0-9]+ %  |^[0-9.]+ orbits .* contrast |^keeler: note: '
  while IFS= read -r line || [ -n "$line" ]; do
    [[ $line =~ $besides ]] || said+=("$line")
  done <"$work/err"
  [ "${#said[@]}" -eq 1 ] || fail "$1: not one line: $(cat "$work/err")"
  [[ ${said[0]-} == "keeler: "* ]] || fail "$1: does not name the program: $(cat "$work/err")"
  [[ ${said[0]-} == *"$2"* ]] || fail "$1: no '$2' in: $(cat "$work/err")"
}

# refuses_with CODE NAME WORDS ARGUMENT...: the program ends with this code, nothing on stdout, and one message with the words
refuses_with() {
  local code=$1 name=$2 words=$3
  shift 3
  runs "$code" "$@"
  [ -s "$work/out" ] && fail "$name: printed $(cat "$work/out")"
  one_line "$name" "$words"
}

refuses() { refuses_with 2 "$@"; }

# small_scene: writes a scene with self-gravity that runs for an orbit in a fraction of a second
small_scene() {
  cat >"$work/scene.toml" <<END
title = "Small patch"
[planet]
preset = "saturn-a-ring"
[box]
size = [50, 50] # m
[particles]
count = 400
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
kick_every = 1
solver = "tree"
[time]
step = 2e-3
end = 1.0
[output]
snapshot_every = 0.25
checkpoint_every = 0.1
END
}

# text KEY FILE: prints a text or number of a JSON file that contains the key once
text() { sed -nE "s/^ *\"$1\": *\"?([^\",]*)\"?,?\$/\1/p" "$2" | head -n 1; }

newest_checkpoint() { find "$1" -name 'checkpoint_*.h5' | sort | tail -n 1; }

# state_hash FOLDER: prints the hash of the newest checkpoint
state_hash() {
  "$keeler" info "$(newest_checkpoint "$1")" --json >"$work/info.json" 2>&1 || fail "info: $(cat "$work/info.json")"
  text state_hash "$work/info.json"
}

# same_bytes NAME GROUP A B [A B]...: the datasets in this group of the HDF5 files are identical, pair by pair
same_bytes() {
  local name=$1
  shift
  /usr/bin/python3 -B "$source_dir/tests/cli/same_bytes.py" "$@" >"$work/differs" || fail "$name: $(head -n 3 "$work/differs")"
}

# same_state NAME FOLDER FOLDER: the newest checkpoints are equal in every field except the numbers of written files
same_state() {
  [ "$(state_hash "$2")" = "$(state_hash "$3")" ] || fail "$1: state_hash differs"
  same_bytes "$1" /fields "$(newest_checkpoint "$2")" "$(newest_checkpoint "$3")"
}

same_series() {
  cmp "$2/series.csv" "$3/series.csv" || fail "$1: series.csv differs"
  [ -z "$(cut -d , -f 1 "$3/series.csv" | sort | uniq -d)" ] || fail "$1: doubled rows in series.csv"
}

same_snapshots() {
  local file pairs=()
  [ "$(cd "$2" && echo snap_*)" = "$(cd "$3" && echo snap_*)" ] || fail "$1: other snapshots: $(cd "$3" && echo snap_*)"
  for file in "$2"/snap_*.hdf; do
    pairs+=("$file" "$3/${file##*/}")
  done
  same_bytes "$1" /PartType1 "${pairs[@]}"
}

# signalled SIGNAL FOLDER ARGUMENT...: starts `keeler ARGUMENT...`, sends the signal when FOLDER has a checkpoint, and sets
# $signalled to the exit code
signalled() {
  local signal=$1 folder=$2 process
  shift 2
  "$keeler" "$@" >"$work/out" 2>"$work/err" &
  process=$!
  until compgen -G "$folder/checkpoint_*.h5" >/dev/null || ! kill -0 "$process" 2>/dev/null; do
    sleep 0.01
  done
  kill "-$signal" "$process" 2>/dev/null
  signalled=0
  wait "$process" 2>/dev/null || signalled=$?
}

# interrupted SIGNAL CODE FOLDER ARGUMENT...: makes a run of the small scene that ends with this code between its first
# checkpoint and orbit 1; repeats it if the signal came too late
interrupted() {
  local signal=$1 code=$2 folder=$3
  shift 3
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    rm -rf "$folder"
    signalled "$signal" "$folder" run "$work/scene.toml" -o "$folder" "$@"
    [ "$signalled" -eq "$code" ] && return
  done
  fail "SIG$signal: exit $signalled instead of $code: $(tail -n 3 "$work/err")"
}

# commands_in FILE: prints the commands in a text of --help
commands_in() { sed '/^Examples:/,$d; /^Options:/,/^$/d' "$1" | sed -nE 's/^  ([a-z]+) +[a-z].*/\1/p' | sort; }
