#!/bin/bash
# sweep.sh KEELER SOURCE_DIR: the tables of a sweep are bitwise identical after kills and stops and with several processes; a
# run that fails or is killed does not affect the others; an invalid grid writes nothing.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene

# small_grid [SEEDS]: writes a grid of two points with some seeds
small_grid() {
  cat >"$work/grid.toml" <<END
scene = "scene.toml"
seeds = [${1:-1, 2}]
since = 0.2
[set]
"time.end" = 0.8
[[axis]]
key = "particles.density"
values = [300.0, 600.0]
END
}
small_grid
results="sweep.csv points.csv figure.svg report.md"

same_tables() {
  local name
  for name in $results; do
    cmp "$work/whole/$name" "$2/$name" || fail "$1: $name differs"
  done
}

finished() { grep -l '"finished": true' "$1"/runs/*/summary.json 2>/dev/null | wc -l; }
has_checkpoint() { compgen -G "$1/runs/*/checkpoint_*.h5" >/dev/null; }
one_finished() { [ "$(finished "$1")" -ge 1 ]; }

# swept_until CONDITION FOLDER ARGUMENT...: starts a sweep and waits for the condition; sets $sweep and its $runs
swept_until() {
  local condition=$1 folder=$2
  shift 2
  "$keeler" sweep "$work/grid.toml" -o "$folder" "$@" >"$work/out" 2>"$work/err" &
  sweep=$!
  until "$condition" "$folder" || ! kill -0 "$sweep" 2>/dev/null; do sleep 0.01; done
  mapfile -t runs < <(pgrep -P "$sweep")
}

runs 0 sweep "$work/grid.toml" -o "$work/whole" --jobs 1 --json
[ "$(text finished "$work/out")" -eq 4 ] || fail "sweep: $(cat "$work/out")"
[ "$(wc -l <"$work/whole/sweep.csv")" -eq 5 ] || fail "sweep.csv: $(cat "$work/whole/sweep.csv")"
[ "$(wc -l <"$work/whole/points.csv")" -eq 3 ] || fail "points.csv: $(cat "$work/whole/points.csv")"
grep -qx 'particles.density (kg/m³)' "$work/whole/figure.svg" || fail "figure.svg: no label of x"
for name in sweep.csv points.csv report.md; do
  runs 0 sweep "$work/grid.toml" -o "$work/whole"
  prints "sweep" "$work/whole/$name"
done

# column NAME ROW FILE: prints one cell of a table
column() {
  awk -F, -v name="$1" -v row="$2" 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == name) column = k }
    NR == row { print $column }' "$3"
}

# A row equals the numbers of analyze, and a run by hand is identical.
name=density-300_seed-1
runs 0 analyze "$work/whole/runs/$name" --since 0.2 --json
for number in total_viscosity_m2_s total_viscosity_error_m2_s translational_viscosity_r2_omega energy_balance \
  energy_balance_error since_orbit wake_contrast; do
  value=$(column "$number" 2 "$work/whole/sweep.csv")
  [ "$value" = "$(text "$number" "$work/out")" ] || fail "$number is '$value', analyze: $(text "$number" "$work/out")"
done
runs 0 run "$work/whole/scenes/$name.toml" -o "$work/by_hand"
same_state "by hand" "$work/whole/runs/$name" "$work/by_hand"
runs 0 run "$work/scene.toml" -o "$work/by_set" --set time.end=0.8 --set particles.density=300.0
same_state "by --set" "$work/whole/runs/$name" "$work/by_set"

# Killed twice, the runs with it, first early and then between two runs.
for _ in 1 2 3 4 5; do
  rm -rf "$work/killed"
  swept_until has_checkpoint "$work/killed" --jobs 2
  kill -9 "$sweep" "${runs[@]}" 2>/dev/null
  wait "$sweep" 2>/dev/null
  after_first=$(finished "$work/killed")
  swept_until one_finished "$work/killed" --jobs 1
  kill -9 "$sweep" "${runs[@]}" 2>/dev/null
  wait "$sweep" 2>/dev/null
  after_second=$(finished "$work/killed")
  [ "$after_first" -eq 0 ] && [ "$after_second" -ge 1 ] && [ "$after_second" -le 3 ] && break
done
[ "$after_second" -le 3 ] || fail "killed: $after_first, then $after_second had finished"
runs 0 sweep "$work/grid.toml" -o "$work/killed" --tables
[ "$(wc -l <"$work/killed/sweep.csv")" -eq $((1 + after_second)) ] || fail "tables in between: $(cat "$work/killed/sweep.csv")"
runs 0 sweep "$work/grid.toml" -o "$work/killed"
same_tables "killed twice" "$work/killed"

# Only the sweep is killed: its runs stop with a checkpoint, and the next sweep waits for them.
swept_until has_checkpoint "$work/orphans" --jobs 2
kill -9 "$sweep"
wait "$sweep" 2>/dev/null
runs 0 sweep "$work/grid.toml" -o "$work/orphans" --jobs 2
same_tables "the program alone killed" "$work/orphans"
grep -q '"stopped"' "$work/orphans"/runs/*/log.jsonl || fail "runs without their sweep were not stopped"

# Stopped.
swept_until has_checkpoint "$work/stopped" --jobs 2
kill -TERM "$sweep" "${runs[@]}" # as a queue does it: to all
code=0
wait "$sweep" || code=$?
[ "$code" -eq 75 ] || fail "TERM: exit $code: $(cat "$work/err")"
grep -q "the same command continues" "$work/err" || fail "TERM: no advice: $(cat "$work/err")"
for process in "${runs[@]}"; do
  kill -0 "$process" 2>/dev/null && fail "TERM: a run goes on"
done
grep -q 'given up' "$work/stopped"/runs/*/log.jsonl && fail "TERM: a step was given up"
[ -n "$(ls "$work/stopped/failed")" ] && fail "TERM: a stopped run counts as failed"
runs 0 sweep "$work/grid.toml" -o "$work/stopped"
same_tables "TERM" "$work/stopped"

# Three processes in one folder: each run is carried out exactly once.
processes=()
for k in 1 2 3; do
  "$keeler" sweep "$work/grid.toml" -o "$work/shared" --jobs 1 >"$work/out.$k" 2>"$work/err.$k" &
  processes+=($!)
done
for process in "${processes[@]}"; do
  wait "$process" || fail "shared: $(cat "$work"/err.*)"
done
same_tables "shared" "$work/shared"
[ "$(cat "$work"/shared/runs/*/log.jsonl | grep -c '"started"')" -eq 4 ] || fail "shared: a run was begun twice"
grep -q '"resumed"' "$work"/shared/runs/*/log.jsonl && fail "shared: a run was cut"

# Programs that start simultaneously accept the folder that the first of them makes.
for try in 1 2 3 4 5 6 7 8 9 10; do
  processes=()
  for k in 1 2 3 4; do
    "$keeler" sweep "$work/grid.toml" -o "$work/at_once.$try" --tables >"$work/out.$k" 2>"$work/err.$k" &
    processes+=($!)
  done
  for process in "${processes[@]}"; do
    wait "$process" || fail "at once: $(cat "$work"/err.*)"
  done
done

# One run is killed: the others continue, and the next call finishes it.
swept_until has_checkpoint "$work/one" --jobs 2
kill -9 "${runs[0]}"
code=0
wait "$sweep" || code=$?
[ "$code" -eq 1 ] || fail "a killed run: exit $code: $(cat "$work/err")"
[ "$(finished "$work/one")" -eq 3 ] || fail "a killed run took others with it"
grep -q ',failed,the run was ended by signal 9' "$work/one/sweep.csv" || fail "a killed run: $(cut -c 1-200 "$work/one/sweep.csv")"
runs 0 sweep "$work/grid.toml" -o "$work/one"
same_tables "a killed run" "$work/one"

# One run cannot begin.
runs 0 sweep "$work/grid.toml" -o "$work/blocked" --tables
touch "$work/blocked/runs/$name"
runs 1 sweep "$work/grid.toml" -o "$work/blocked"
grep -q "^$name,300.*,1,failed,.*is a file" "$work/blocked/sweep.csv" || fail "blocked: $(cut -c 1-200 "$work/blocked/sweep.csv")"
grep -q "is a file" "$work/blocked/report.md" || fail "the report does not say what failed"
[ "$(column finished_runs 2 "$work/blocked/points.csv")" = 1 ] || fail "blocked: $(cat "$work/blocked/points.csv")"

# More seeds only add runs; other settings, other content and wrong grids are refused.
stat -c '%n %Y %s' "$work"/whole/runs/*/* >"$work/before"
small_grid "3, 1, 2"
runs 0 sweep "$work/grid.toml" -o "$work/whole"
[ "$(finished "$work/whole")" -eq 6 ] || fail "a new seed: $(finished "$work/whole") runs"
stat -c '%n %Y %s' "$work"/whole/runs/*/* | sort | comm -13 - <(sort "$work/before") >"$work/lost"
[ -s "$work/lost" ] && fail "a new seed changed: $(cat "$work/lost")"
small_grid 1
runs 0 sweep "$work/grid.toml" -o "$work/whole"
grep -q "4 runs in .* outside this grid" "$work/err" || fail "fewer seeds: $(cat "$work/err")"
sed -i 's/0\.8$/3.0/' "$work/grid.toml"
# The name of the folder may begin with a dash.
cat >"$work/small.toml" <<END
scene = "scene.toml"
seeds = [1, 2]
[set]
"time.end" = 0.01
END
(cd "$work" && "$keeler" sweep small.toml --output=-dash >"$work/out" 2>"$work/err") || fail "a dash: $(cat "$work/err")"
[ -s "$work/-dash/sweep.csv" ] || fail "a dash: no table"

# Values of a grid are plain texts in a figure.
cat >"$work/texts.toml" <<END
scene = "scene.toml"
since = 0.01
[set]
"time.end" = 0.3
"output.series_every" = 0.01
"output.stress_every" = 0.01
[[axis]]
key = "particles.density"
values = [500, 600]
[[axis]]
key = "title"
values = ["x", "100% | 'a'\\nsystem \\"touch $work/touched\\"\\n#\\u0000\\u001B[31m"]
[plot]
x = "title"
y = "dispersion_x_m_s"
END
runs 0 sweep "$work/texts.toml" -o "$work/texts" -q
[ -s "$work/err" ] && fail "texts: $(cat "$work/err")"
grep -q "^| 500 | 100% .| 'a'?system" "$work/texts/report.md" || fail "texts: $(cat "$work/texts/report.md")"
grep -q "100% | 'a'?system" "$work/texts/figure.svg" || fail "texts: no label in figure.svg"
rm "$work/texts/report.md" "$work/texts/figure.png"
mkdir -p "$work/texts/figure.png/kept" # an empty folder would be replaced
runs 4 sweep "$work/texts.toml" -o "$work/texts" -q --json
one_line "a figure that fails" "'$work/texts/figure.png'"
[ "$(text finished "$work/out")" -eq 4 ] || fail "a figure that fails: $(cat "$work/out")"
[ -s "$work/texts/report.md" ] || fail "a figure that fails: no report"

# Finished runs that cannot be measured.
runs 0 sweep "$work/small.toml" -o "$work/damaged" -q
sed -i 's/.*/x/' "$work/damaged/runs/seed-1/series.csv"
runs 1 sweep "$work/small.toml" -o "$work/damaged" -q
one_line "a damaged run" "1 finished run cannot be measured, sweep.csv has the reasons; remove the damaged files"
prints "a damaged run" "2 runs: 1 finished, 1 failed"
[ "$(column finished_runs 2 "$work/damaged/points.csv")" = 1 ] || fail "a damaged run: $(cat "$work/damaged/points.csv")"
grep -q "^seed-1,1,failed,.*series.csv" "$work/damaged/sweep.csv" || fail "a damaged run: $(cut -c 1-200 "$work/damaged/sweep.csv")"
sed -i 's/.*/x/' "$work/damaged/runs/seed-2/series.csv"
runs 1 sweep "$work/small.toml" -o "$work/damaged" -q
[ -e "$work/damaged/points.csv" ] && fail "nothing to measure: the table of points of an earlier call is still there"
rm -r "$work/damaged/runs"/*
runs 0 sweep "$work/small.toml" -o "$work/damaged" -q

# A stopped --tables starts no run.
code=0
timeout 60 /usr/bin/python3 -c 'import os, signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
os.kill(os.getpid(), signal.SIGTERM)
os.execv(sys.argv[1], sys.argv[1:])' "$keeler" sweep "$work/small.toml" -o "$work/damaged" --tables 2>"$work/err" || code=$?
[ "$code" -eq 75 ] || fail "tables that are stopped: exit $code"
one_line "tables that are stopped" "stopped before the tables were made"

# A signal stops the planning of many runs.
{ echo 'scene = "scene.toml"' && seq -s ', ' 1 100000 | sed 's/^/seeds = [/; s/$/]/'; } >"$work/many.toml"
"$keeler" sweep "$work/many.toml" -o "$work/many" >"$work/out" 2>"$work/err" &
many=$!
sleep 1
kill -INT "$many"
code=0
wait "$many" || code=$?
[ "$code" -eq 75 ] || fail "INT while runs are planned: exit $code: $(tail -n 3 "$work/err")"
[ -e "$work/many" ] && fail "INT while runs are planned: a folder was made"

refuses "another end" "was made with time.end = 0.8 and now has time.end = 3.0" sweep "$work/grid.toml" -o "$work/whole"
refuses "another's folder" "holds no sweep" sweep "$work/grid.toml" -o "$work/by_hand"
refuses "a file" "is a file" sweep "$work/grid.toml" -o "$work/scene.toml"
refuses "no grid" "cannot be read" sweep "$work/none.toml" -o "$work/none"
refuses "no jobs" "from 1 to" sweep "$work/grid.toml" -o "$work/none" --jobs 0
sed -i 's/particles.density/particles.densty/' "$work/grid.toml"
refuses "a wrong key" "grid.toml:7:7: unknown key particles.densty" sweep "$work/grid.toml" -o "$work/none"
[ -e "$work/none" ] && fail "a refused sweep wrote something"

# The example, short.
sed "s#\"../#\"$source_dir/examples/#; s/^\"time.end\" = .*/\"time.end\" = 0.2/; s/^since = .*/since = 0.1/" \
  "$source_dir/examples/sweep-viscosity/grid.toml" >"$work/example.toml"
runs 0 sweep "$work/example.toml" -o "$work/example"
[ "$(wc -l <"$work/example/points.csv")" -eq 9 ] || fail "the example: $(cut -c 1-100 "$work/example/points.csv")"

report
