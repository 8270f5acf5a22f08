#!/bin/bash
# signals.sh KEELER SOURCE_DIR: INT, TERM, USR1 and --wall-time stop a run with exit code 75 and a checkpoint; USR2
# writes a snapshot and the run continues. The runs would last for hours, so no signal comes too late.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
endless=(run "$work/scene.toml" --set time.end=1e5 --set output.snapshot_every=0 --set output.checkpoint_every=0.01)

# stopped NAME FOLDER: the folder has the files of a stopped run
stopped() {
  runs 0 info "$(newest_checkpoint "$2")" --json
  cp "$work/out" "$work/info.json"
  runs 0 analyze "$2"
  [ "$(text finished "$2/summary.json")" = false ] || fail "$1: summary says finished"
  for key in state_hash time_orbits; do
    [ "$(text $key "$work/info.json")" = "$(text $key "$2/summary.json")" ] || fail "$1: $key is not the checkpoint's"
  done
}

for signal in INT TERM USR1; do
  signalled $signal "$work/$signal" "${endless[@]}" -o "$work/$signal"
  [ "$signalled" -eq 75 ] || fail "$signal: exit $signalled"
  grep -q "continue with \"keeler resume $work/$signal\"" "$work/err" || fail "$signal: no advice: $(cat "$work/err")"
  stopped $signal "$work/$signal"
done

# A signal that is pending when the program begins, as one before the handlers are installed.
pending='import os, signal, sys
number = getattr(signal, sys.argv[1])
signal.pthread_sigmask(signal.SIG_BLOCK, [number])
os.kill(os.getpid(), number)
os.execv(sys.argv[2], sys.argv[2:])'
for signal in INT TERM HUP USR1; do
  code=0
  timeout 60 /usr/bin/python3 -c "$pending" "SIG$signal" "$keeler" "${endless[@]}" -o "$work/early" --wall-time 3 \
    2>"$work/err" || code=$?
  [ "$code" -eq 1 ] || fail "early $signal: exit $code: $(cat "$work/err")"
  grep -q 'stopped before the first step (on request)' "$work/err" || fail "early $signal: $(cat "$work/err")"
  [ ! -e "$work/early" ] || fail "early $signal: something was written"
done
# other commands end at once
code=0
{ timeout 60 /usr/bin/python3 -c "$pending" SIGUSR1 "$keeler" check "$work/scene.toml" >"$work/out" || code=$?; } 2>/dev/null
[ "$code" -eq 138 ] || fail "early USR1, keeler check: exit $code"

# Signals also end waiting for a pipe; otherwise `timeout -k` kills the program.
accepts "a run" run "$work/scene.toml" -o "$work/done" --set time.end=0.2 -q
mkfifo "$work/pipe"
fixed() { # NAME: a copy of the run with a pipe in the place of this file
  cp -r "$work/done" "$work/with-$1"
  rm "$work/with-$1/$1"
  mkfifo "$work/with-$1/$1"
}
for name in log.jsonl series.csv; do fixed "$name"; done
waiting=()
: >"$work/deaf"
while read -r command; do
  {
    code=0
    # shellcheck disable=SC2086 # several words
    timeout -k 20 1 "$keeler" $command >/dev/null 2>&1 || code=$?
    [ "$code" -eq 124 ] || echo "exit $code: $command" >>"$work/deaf"
  } &
  waiting+=($!)
done <<END
run $work/pipe -o $work/none
check $work/pipe
sweep $work/pipe -o $work/none
study step $work/pipe -o $work/none
generate $work/scene.toml --from-table $work/pipe -o $work/none.hdf
resume $work/with-log.jsonl --until 1
resume $work/with-series.csv --until 1
render $work/with-series.csv --series
END
wait "${waiting[@]}"
[ -s "$work/deaf" ] && fail "not ended by TERM while it waits for a pipe: $(cat "$work/deaf")"

runs 75 "${endless[@]}" -o "$work/wall" --wall-time 0.5
stopped "--wall-time" "$work/wall"
runs 75 resume "$work/wall" --until 1e4 --wall-time 0.5
grep -q "resume $work/wall --until 10000" "$work/err" || fail "--until is not in the advice: $(cat "$work/err")"
stopped "resume --wall-time" "$work/wall"

"$keeler" "${endless[@]}" -o "$work/asked" >"$work/out" 2>"$work/err" &
process=$!
until compgen -G "$work/asked/checkpoint_*" >/dev/null; do sleep 0.01; done
for n in 1 2; do
  kill -USR2 "$process"
  until [ -e "$work/asked/snap_00000$n.hdf" ] || ! kill -0 "$process"; do sleep 0.01; done
done
kill -TERM "$process"
code=0
wait "$process" || code=$?
[ "$code" -eq 75 ] || fail "USR2, then TERM: exit $code"
stopped "USR2" "$work/asked"
runs 0 info "$work/asked/snap_000002.hdf" --json
later=$(printf '%s\n' "$(text time_orbits "$work/out")" "$(text time_orbits "$work/asked/summary.json")" | sort -g | tail -n 1)
[ "$later" = "$(text time_orbits "$work/asked/summary.json")" ] || fail "USR2: the run did not go on"

report
