#!/bin/bash
# watch.sh KEELER SOURCE_DIR: progress fits the terminal, and keeler watch shows the state of a run while it works and after
# its end, in a pipe and on terminals of 40 and 120 columns.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
on_terminal() { /usr/bin/python3 "$source_dir/tests/cli/terminal.py" "$@"; }

for columns in 40 120; do
  # The summary at the end is a table for a wide terminal or a file; it goes to one.
  on_terminal "$columns" /bin/sh -c "'$keeler' run '$work/scene.toml' -o '$work/run$columns' >'$work/summary'" \
    >"$work/drawn" 2>"$work/err" || fail "run, $columns columns: $(cat "$work/err")"
  grep -q "orbits .* 100 %" "$work/drawn" || fail "run, $columns columns: no progress: $(cat "$work/drawn")"
  on_terminal "$columns" "$keeler" watch "$work/run$columns" >"$work/drawn" 2>"$work/err" ||
    fail "watch, $columns columns: $(cat "$work/err")"
  for words in finished "orbit" "snapshot    snap_" "checkpoint  checkpoint_" "c_x, m/s" "collisions/orbit" "█"; do
    grep -qF "$words" "$work/drawn" || fail "watch, $columns columns: no '$words' in $(cat "$work/drawn")"
  done
done
grep -q "\[####" "$work/drawn" || fail "no bar"

accepts "in a pipe" watch "$work/run40"
prints "in a pipe" "finished"
grep -q $'\033' "$work/out" && fail "a pipe got a terminal's codes"

# A working and a killed run.
"$keeler" run "$work/scene.toml" --set time.end=1e5 --set output.snapshot_every=0 -o "$work/works" >/dev/null 2>&1 &
process=$!
until [ -s "$work/works/series.csv" ] && [ "$(wc -l <"$work/works/series.csv")" -gt 3 ]; do sleep 0.05; done
until { accepts "at work" watch "$work/works"; grep -q " left" "$work/out"; } || ! kill -0 "$process"; do sleep 0.1; done
prints "at work" "running, "
prints "at work" " left"
prints "at work" " of 100000"
kill -KILL "$process"
wait "$process" 2>/dev/null
accepts "killed" watch "$work/works"
prints "killed" "not running"
# A partial line of the log, as while a run writes it.
printf '{"event":"fini' >>"$work/works/log.jsonl"
accepts "half a line" watch "$work/works"
prints "half a line" "not running"
grep -q '"event":"started",.*"time":"20[0-9-]*T[0-9:]*Z"' "$work/works/log.jsonl" || fail "the log has no times"

mkdir "$work/empty"
refuses_with 4 "no run" "log.jsonl is missing" watch "$work/empty"
refuses_with 4 "no folder" "log.jsonl is missing" watch "$work/nowhere"
report
