#!/bin/bash
# restart.sh KEELER SOURCE_DIR: state, time series and snapshots of a run are bitwise identical for any interruptions and any
# number of threads.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
command -v h5ls >/dev/null || { echo "'h5ls' is missing: scripts/setup test installs it"; exit 1; }
small_scene

# same NAME FOLDER: all files of the run equal those of the uninterrupted run
same() {
  same_state "$1" "$work/whole" "$2"
  same_series "$1" "$work/whole" "$2"
  same_snapshots "$1" "$work/whole" "$2"
}

runs 0 run "$work/scene.toml" -o "$work/whole" --threads 1

runs 0 run "$work/scene.toml" -o "$work/two" --threads 2
same "two threads" "$work/two"

for set in portable avx2 avx512; do
  [ $set = portable ] || grep -qw "${set/512/512f}" /proc/cpuinfo || continue
  KEELER_SIMD=$set runs 0 run "$work/scene.toml" -o "$work/$set"
  same "instructions: $set" "$work/$set"
done

runs 0 run "$work/scene.toml" -o "$work/half" --set time.end=0.5
runs 0 resume "$work/half" --until 1
same "half and half" "$work/half"

runs 0 run "$work/scene.toml" -o "$work/threads" --set time.end=0.5 --threads 1
runs 0 resume "$work/threads" --until 1 --threads 2
same "half with one thread, half with two" "$work/threads"

# Resuming a finished run changes nothing, not even the time of a file.
times() { stat -c '%n %Y %y %s' "$work/threads"/*; }
times >"$work/before"
cp -r "$work/threads" "$work/copy"
runs 0 resume "$work/threads"
one_line "a finished run, resumed" "is finished, nothing was changed"
prints "a finished run, resumed" "$(state_hash "$work/threads")"
runs 0 resume "$work/threads" --until 1 --json
cmp "$work/out" "$work/threads/summary.json" || fail "a finished run, resumed: another summary"
times | diff "$work/before" - || fail "a finished run, resumed: files were touched"
diff -r "$work/copy" "$work/threads" || fail "a finished run, resumed: files were changed"
runs 0 resume "$work/copy" --until 1.1
[ "$(text steps "$work/copy/summary.json")" -eq 550 ] || fail "a finished run did not go on to a later end"

# An edited scene.toml does not affect the run: its text is saved, and a message gives the command to run it.
runs 0 run "$work/scene.toml" -o "$work/edited" --set time.end=0.5
cp "$work/edited/scene.toml" "$work/written.toml"
sed -i 's/^end = .*/end = 1.0 # longer/' "$work/edited/scene.toml"
cp "$work/edited/scene.toml" "$work/longer.toml"
runs 0 resume "$work/edited"
grep -qF "'$work/edited/scene.toml' was edited, but a run continues with the scene that it began with: \"keeler resume $work/edited --until 1\"" \
  "$work/err" || fail "an edited scene of a finished run: $(cat "$work/err")"
cmp "$work/edited/scene.toml" "$work/longer.toml" || fail "a finished run: its edited scene was changed"
runs 0 resume "$work/edited" --until 1
grep -qF "the edited text is now '$work/edited/scene_edited.toml'" "$work/err" || fail "an edited scene: $(cat "$work/err")"
cmp "$work/edited/scene_edited.toml" "$work/longer.toml" || fail "an edited scene: its text is lost"
cmp "$work/edited/scene.toml" "$work/written.toml" || fail "an edited scene: scene.toml is not that of the run"
same "an edited scene" "$work/edited"
sed -i 's/^elastic_below_speed = .*/elastic_below_speed = 0.05/' "$work/edited/scene.toml"
runs 0 resume "$work/edited" --until 1.02
grep -qF "\"keeler run $work/edited/scene_edited_2.toml --from $work/edited/snap_" "$work/err" || fail "edited physics: $(cat "$work/err")"
grep -qF "(elastic_below_speed = 0.05)" "$work/err" || fail "edited physics: $(cat "$work/err")"
runs 0 resume "$work/edited" --until 1.04
grep -q "was edited" "$work/err" && fail "a scene as it was written is called edited: $(cat "$work/err")"

interrupted KILL 137 "$work/killed"
[ -e "$work/killed/summary.json" ] && fail "killed after its end"
runs 0 resume "$work/killed"
same "kill -9" "$work/killed"

# Killed within a line of the log: the partial line is removed, and every line can be read.
runs 0 run "$work/scene.toml" -o "$work/torn" --set time.end=0.5
truncate -s -20 "$work/torn/log.jsonl"
runs 0 resume "$work/torn" --until 1
same "a torn line in the log" "$work/torn"
/usr/bin/python3 -c 'import json, sys; print([json.loads(line)["event"] for line in open(sys.argv[1])])' "$work/torn/log.jsonl" \
  >"$work/out" || fail "a torn line in the log: $(cat "$work/torn/log.jsonl")"
prints "a torn line in the log" "'resumed'"
truncate -s -20 "$work/torn/log.jsonl"
runs 0 resume "$work/torn"
tail -n 1 "$work/torn/log.jsonl" | grep -q '}$' || fail "a torn line in the log of a finished run"

# Checkpoints by the clock alone, a thousandth of a minute apart.
interrupted KILL 137 "$work/clock" --set output.checkpoint_every=0 --set output.checkpoint_every_minutes=0.001
runs 0 resume "$work/clock"
same "kill -9, checkpoints by the clock" "$work/clock"

interrupted TERM 75 "$work/stopped" --threads 2
runs 0 resume "$work/stopped" --threads 1
same "TERM" "$work/stopped"

# Other output intervals give other files but the same state; the rows of the series are at their own steps.
runs 0 run "$work/scene.toml" -o "$work/schedules" --set output.checkpoint_every=0.034 --set output.snapshot_every=0.07
same_state "other schedules" "$work/whole" "$work/schedules"
same_series "other schedules" "$work/whole" "$work/schedules"

# A run continues in a moved folder; the files that it was made from are not needed.
sources() {
  seq 400 | sed 's/.*/1.0/' >"$work/radii.txt"
  cp "$work/whole/snap_000000.hdf" "$work/start.hdf"
}
for source in "start.from=$work/start.hdf" "particles.sizes={law=\"file\",path=\"$work/radii.txt\"}"; do
  rm -rf "$work/here" "$work/there" "$work/once"
  sources
  runs 0 run "$work/scene.toml" --set "$source" -o "$work/once" --set time.end=0.1
  runs 0 run "$work/scene.toml" --set "$source" -o "$work/here" --set time.end=0.05
  mv "$work/here" "$work/there"
  rm "$work/radii.txt" "$work/start.hdf"
  runs 0 resume "$work/there" --until 0.1
  same_state "moved, $source" "$work/once" "$work/there"
  runs 0 analyze "$work/there"
done

# Rough particles: their spins are part of the state.
cp "$work/scene.toml" "$work/smooth.toml"
mv "$work/whole" "$work/smooth-whole"
printf '\n[collisions.friction]\ntangential_restitution = 0.4\ncoefficient = 0.5\n' >>"$work/scene.toml"
runs 0 run "$work/scene.toml" -o "$work/whole" --threads 1
[ "$(state_hash "$work/whole")" = "$(state_hash "$work/smooth-whole")" ] && fail "friction did nothing"
h5ls "$work/whole/snap_000001.hdf/PartType1" | grep -q Spins || fail "rough particles: no spins in a snapshot"
h5ls "$work/smooth-whole/snap_000001.hdf/PartType1" | grep -q Spins && fail "smooth particles: spins in a snapshot"
for threads in 2 3; do
  runs 0 run "$work/scene.toml" -o "$work/rough-$threads" --threads "$threads"
  same "rough particles, $threads threads" "$work/rough-$threads"
done
interrupted KILL 137 "$work/rough-killed" --threads 2
runs 0 resume "$work/rough-killed" --threads 3
same "rough particles, kill -9" "$work/rough-killed"
mv "$work/smooth.toml" "$work/scene.toml"

# Kicks every third step: ends and schedules are rounded to whole kicks, and no restart falls between two halves.
sed -i 's/^kick_every.*/kick_every = 3/; s/^snapshot_every.*/snapshot_every = 0.13/; s/^checkpoint_every.*/checkpoint_every = 0.07/' \
  "$work/scene.toml"
rm -rf "$work/whole"
runs 0 run "$work/scene.toml" -o "$work/whole"
grep -q "rounded" "$work/err" || fail "kick_every: silent about rounding: $(cat "$work/err")"

runs 0 run "$work/scene.toml" -o "$work/odd" --set time.end=0.5
runs 0 resume "$work/odd" --until 1
same_state "kick_every, half and half" "$work/whole" "$work/odd"
same_series "kick_every, half and half" "$work/whole" "$work/odd"

interrupted TERM 75 "$work/odd-stopped"
runs 0 resume "$work/odd-stopped"
same "kick_every, TERM" "$work/odd-stopped"

interrupted KILL 137 "$work/odd-killed"
runs 0 resume "$work/odd-killed"
same "kick_every, kill -9" "$work/odd-killed"

report
