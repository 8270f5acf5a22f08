#!/bin/bash
# intrusions.sh KEELER SOURCE_DIR: files of a working run are removed, replaced or changed, or its folder is moved. No row is
# lost without a message, and the output is never in two folders; and a kill before old checkpoints are removed leaves no
# permanent third one.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
long=(run "$work/scene.toml" --set time.end=1e5 --set output.snapshot_every=0 --set output.checkpoint_every=0.05)

wait_for() { # FILE
  for ((k = 0; k < 500; k++)); do
    [ -s "$1" ] && return
    sleep 0.02
  done
  fail "no $1 after ten seconds"
}

# begin FOLDER OPTION...: starts a run of hours and waits for its first checkpoint; sets $process
begin() {
  "$keeler" "${long[@]}" -o "$1" "${@:2}" >"$work/out" 2>"$work/err" &
  process=$!
  wait_for "$1/checkpoint_000000.h5"
}

# ends CODE NAME: the run of begin ends with this code within ten seconds
ends() {
  local code=0
  for ((k = 0; k < 500; k++)); do
    kill -0 "$process" 2>/dev/null || break
    sleep 0.02
  done
  kill -KILL "$process" 2>/dev/null
  wait "$process" 2>/dev/null || code=$?
  [ "$code" -eq "$1" ] || fail "$2: exit $code instead of $1: $(cat "$work/err")"
}

# every_row NAME FILE: no row between the first and the last is missing, and none is doubled
every_row() {
  awk -F, 'NR == 2 && $1 != 0 { exit 1 } NR > 2 && $1 != last + 10 { exit 1 } { last = $1 } END { if (NR < 4) exit 1 }' "$2" ||
    fail "$1: rows are missing in $(cut -d , -f 1 "$2" | tr '\n' ' ')"
}

# Removed, renamed and replaced files: the run rewrites the file with all its rows, with a message.
for change in "rm series.csv" "mv series.csv elsewhere.csv" "echo of another hand >new; mv new series.csv"; do
  begin "$work/run"
  (cd "$work/run" && eval "$change")
  wait_for "$work/run/series.csv"
  rows=$(wc -l <"$work/run/series.csv")
  for ((k = 0; k < 500 && $(wc -l <"$work/run/series.csv") <= rows; k++)); do sleep 0.02; done
  kill -TERM "$process"
  ends 75 "$change"
  every_row "$change" "$work/run/series.csv"
  grep -q "series.csv' was removed or replaced while the run wrote to it; it is rewritten" "$work/err" ||
    fail "$change: not said: $(cat "$work/err")"
  grep -q '"restored","file":"series.csv"' "$work/run/log.jsonl" || fail "$change: not in the log"
  rm -rf "$work/run"
done

# Changes of moonlets.csv.
begin "$work/run" --set 'moonlet=[{radius=3.0,density=900.0}]'
rm "$work/run/moonlets.csv"
wait_for "$work/run/moonlets.csv"
kill -TERM "$process"
ends 75 "rm moonlets.csv"
every_row "rm moonlets.csv" "$work/run/moonlets.csv"
rm -rf "$work/run"

# Truncated or changed files: the lost rows cannot be restored, so the run ends.
for change in ": >series.csv" "echo of another hand >>series.csv"; do
  begin "$work/run"
  (cd "$work/run" && eval "$change")
  ends 4 "$change"
  one_line "$change" "series.csv' was changed by another program while the run wrote to it"
  rm -rf "$work/run"
done

# Resumed after rows were lost.
runs 0 run "$work/scene.toml" -o "$work/whole" --set time.end=0.2
runs 0 resume "$work/whole" --until 0.3
grep -q missing "$work/err" && fail "nothing is missing: $(cat "$work/err")"
for change in "rm series.csv" "sed -i 4q series.csv"; do
  cp -r "$work/whole" "$work/run"
  (cd "$work/run" && eval "$change")
  runs 0 resume "$work/run" --until 0.4
  one_line "resumed after $change" "series.csv' from step"
  one_line "resumed after $change" "to 150 are missing; the file continues without them"
  [ "$(tail -n 1 "$work/run/series.csv" | cut -d , -f 1)" -eq 200 ] || fail "resumed after $change: no new rows"
  rm -rf "$work/run"
done

# Invalid rows are refused.
for change in "sed -i '5s/,/;/' series.csv" "sed -i '6s/^[0-9]*/3/' series.csv" "sed -i '1s/^/x/' series.csv"; do
  cp -r "$work/whole" "$work/run"
  (cd "$work/run" && eval "$change")
  refuses_with 4 "resumed after $change" "series.csv'" resume "$work/run" --until 0.4
  one_line "resumed after $change" "remove the file to go on without its rows"
  rm -rf "$work/run"
done
cp -r "$work/whole" "$work/run"
sed -i '3d;6d' "$work/run/series.csv"
runs 0 resume "$work/run" --until 0.4
one_line "rows in the middle" "from step 10 to 19, and 1 gap more, are missing"
rm -rf "$work/run"

# The folder is moved, replaced by another, or removed.
for change in "mv run there" "mv run there; mkdir run" "until rm -r run; do :; done"; do
  begin "$work/run"
  (cd "$work" && eval "$change" 2>/dev/null)
  ends 4 "$change"
  sed -i "/series.csv' was removed or replaced/d" "$work/err" # rm takes it first, and the run may see that
  one_line "$change" "was moved, replaced or removed while the run wrote to it"
  [ -e "$work/run" ] && [ -n "$(ls -A "$work/run")" ] && fail "$change: split: $(ls "$work/run")"
  if [ -e "$work/there" ]; then
    runs 0 resume "$work/there" --until "$(text time_orbits <("$keeler" info "$(newest_checkpoint "$work/there")" --json) | awk '{print $1 + 0.1}')"
    every_row "$change" "$work/there/series.csv"
  fi
  rm -rf "$work/run" "$work/there"
done

# A kill between a checkpoint and the removal of older ones: at the last checkpoint of the run, and at an earlier one.
runs 0 run "$work/scene.toml" -o "$work/early" --set time.end=0.2
runs 0 run "$work/scene.toml" -o "$work/killed" --set time.end=0.4
cp "$work/early/checkpoint_000001.h5" "$work/killed/"
rm "$work/killed/summary.json"
[ "$(find "$work/killed" -name 'checkpoint_*' | wc -l)" -eq 3 ] || fail "not three checkpoints: $(ls "$work/killed")"
cp -r "$work/killed" "$work/damaged"
runs 0 resume "$work/killed"
[ "$(find "$work/killed" -name 'checkpoint_*' | wc -l)" -eq 2 ] || fail "three checkpoints stay: $(ls "$work/killed")"
for newest in "$work"/damaged/checkpoint_00000[23].h5; do truncate -s -100 "$newest"; done
runs 0 resume "$work/damaged" --until 0.4
[ "$(state_hash "$work/damaged")" = "$(state_hash "$work/killed")" ] || fail "the oldest of three: another state"
[ "$(find "$work/damaged" -name 'checkpoint_*' | wc -l)" -eq 2 ] || fail "the oldest of three: $(ls "$work/damaged")"

report
