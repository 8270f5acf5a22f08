#!/bin/bash
# run.sh KEELER SOURCE_DIR MPIEXEC OTHER_BUILD: distributed runs have the bits of one process, for any number of ranks and
# threads, and of ranks after a restart; errors end all ranks with one line of Keeler's and its exit code.
# shellcheck source=tests/ranks/helpers.sh
source "$(dirname "$0")/helpers.sh"
other_build=$4
scene uniform '[box]
size = [150, 60]
[particles]
count = 1500
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 0.2
[output]
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.1'
scene wakes '[box]
size = [150, 100]
[particles]
count = 2500
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = "fft"
resting_contacts = "bounced"
[time]
step = 2e-3
end = 0.2
[output]
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.1'
scene sizes '[box]
size = [60, 40]
[particles]
count = 2000
density = 600.0
sizes = { law = "power", exponent = 3.0, min = 0.03, max = 3.0 }
[collisions.friction]
tangential_restitution = 0.5
[gravity]
solver = "auto"
resting_contacts = "bounced"
[time]
step = "auto"
end = 0.125
[output]
series_every = 0.03125'
# it crosses the edge of the box
scene moonlet '[box]
size = [120, 60]
[particles]
count = 700
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[[moonlet]]
radius = 6.0
density = 700.0
position = [59, -9, 0]
velocity = [0.004, 0, 0]
[gravity]
solver = "fft"
resting_contacts = "bounced"
[time]
step = 2e-3
end = 0.2
[output]
collisions = { min_speed = 1e-4 }
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.1'

for name in uniform wakes sizes moonlet; do
  on_all_ranks "$name"
done

# Stopped on 4 ranks, resumed on 3, then on one.
on_ranks 4 1 0 run "$work/wakes.toml" -o "$work/cut" --set time.end=0.1
on_ranks 3 1 0 resume "$work/cut" --until 0.16
runs 0 resume "$work/cut" --until 0.2
[ "$(state_hash "$work/cut")" = "$(state_hash "$work/wakes-1")" ] || fail "4, 3, 1 ranks: state_hash differs"
same_series "4, 3, 1 ranks" "$work/wakes-1" "$work/cut"

# More particles than one piece: equal files, and after resuming the root needs far less memory than one process. (It
# writes, with some 40 MB for pieces of files and messages for any number of particles: so there are many here.)
scene many '[box]
size = [6000, 600]
[particles]
count = 600000
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 4e-3
[output]
series_every = 2e-3'
peak() { text peak_memory_mb "$1/summary.json"; }
runs 0 run "$work/many.toml" -o "$work/many-1"
on_ranks 4 1 0 run "$work/many.toml" -o "$work/many-4"
same "many" "$work/many-1" "$work/many-4"
(
  ulimit -f 18000 # a checkpoint's second piece does not fit
  on_ranks 4 1 4 resume "$work/many-4" --until 8e-3
  report >/dev/null
) || fail "many: a full disk"
[ "$(find "$work/many-4" -name 'checkpoint_*' | wc -l)" -eq 1 ] || fail "many: a full disk: other checkpoints"
on_ranks 4 1 0 resume "$work/many-4" --until 8e-3
runs 0 resume "$work/many-1" --until 8e-3
same "many, resumed" "$work/many-1" "$work/many-4"
awk "BEGIN { exit !($(peak "$work/many-4") < 0.85 * $(peak "$work/many-1")) }" ||
  fail "many: the first of 4 ranks took $(peak "$work/many-4") MB, one process $(peak "$work/many-1") MB"

# A snapshot as a start is read in parts.
last_of() { find "$1" -name 'snap_*.hdf' | sort | tail -n 1; }
cat >"$work/from.toml" <<END
[planet]
preset = "saturn-a-ring"
[start]
from = "$(last_of "$work/many-1")"
keep_fraction = 0.9
[time]
step = 2e-3
end = 4e-3
END
runs 0 run "$work/from.toml" -o "$work/from-1"
on_ranks 4 1 0 run "$work/from.toml" -o "$work/from-4"
same "a snapshot as start" "$work/from-1" "$work/from-4"
awk "BEGIN { exit !($(peak "$work/from-4") < 0.75 * $(peak "$work/from-1")) }" ||
  fail "a snapshot as start: the first of 4 ranks took $(peak "$work/from-4") MB, one process $(peak "$work/from-1") MB"

# Commands for one process, and impossible runs, are refused before anything is written.
refused() { # WORDS ARGUMENT...
  local words=$1
  shift
  on_ranks 2 1 2 "$@"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "$words: not one line: $(cat "$work/all")"
  grep -qF -- "$words" "$work/err" || fail "no '$words' in: $(cat "$work/err")"
  [ ! -e "$work/none" ] || fail "$words: something was written"
}
refused "'keeler analyze' is for one process" analyze "$work/uniform-1"
refused "'keeler bench drift' is for one process" bench drift --count 100
refused 'particles.count' run "$work/uniform.toml" -o "$work/none" --set particles.count=-1
refused "is not empty" run "$work/uniform.toml" -o "$work/uniform-1"

# Ranks with different requests start no run: exit 2 on all, one line that names the difference, nothing written.
# differ WORDS FIRST OTHERS: arguments of the root, in folder a, and of two other ranks, in folder b
mkdir "$work/a" "$work/b"
differ() {
  local words=$1 code=0 of_first of_others
  read -ra of_first <<<"$2"
  read -ra of_others <<<"$3"
  OMP_NUM_THREADS=1 timeout 60 "$mpiexec" --oversubscribe --bind-to none "${transport[@]}" \
    -n 1 -wdir "$work/a" "$keeler" "${of_first[@]}" : -n 2 -wdir "$work/b" "$keeler" "${of_others[@]}" \
    >"$work/out" 2>"$work/all" </dev/null || code=$?
  grep '^keeler: ' "$work/all" >"$work/err"
  [ "$code" -eq 2 ] || fail "$words: exit $code instead of 2: $(cat "$work/all")"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "$words: not one line: $(cat "$work/all")"
  grep -qF -- "$words" "$work/err" || fail "no '$words' in: $(cat "$work/err")"
  [ ! -s "$work/out" ] || fail "$words: printed $(cat "$work/out")"
  [ ! -e "$work/none" ] || fail "$words: something was written"
}
uniform="run $work/uniform.toml -o $work/none"
differ 'the request of rank 1 differs from that of rank 0: it has title = "wakes", and rank 0 has title = "uniform"' \
  "$uniform" "run $work/wakes.toml -o $work/none"
differ 'it has time.end = 0.3, and rank 0 has time.end = 0.2' "$uniform" "$uniform --set time.end=0.3"
differ 'it has no gravity.' "$uniform --set gravity.solver=fft --set gravity.kick_every=1" "$uniform"
differ 'and rank 0 has no gravity.' "$uniform" "$uniform --set gravity.solver=fft"
differ "it has the folder = $work/b/none, and rank 0 has the folder = $work/none" "$uniform" \
  "run $work/uniform.toml -o none"
differ 'it has --force = given' "$uniform" "$uniform --force"
differ 'it has --wall-time = 10' "$uniform" "$uniform --wall-time 10"
differ 'it has the command = keeler bench step, and rank 0 has the command = keeler run' "$uniform" \
  'bench step --count 1000 --state clumped --solver fft'
differ 'it has the command = keeler run, and rank 0 has the command = keeler bench step' \
  'bench step --count 1000 --state clumped --solver fft' "$uniform"
differ 'the command = keeler resume' "resume $work/uniform-1" "$uniform"
differ 'the command = keeler run --help' "$uniform" 'run --help'
differ 'the command = keeler --version' '--version' "$uniform"
differ "the command = keeler, and" "$uniform" ''
differ 'it has --until = 0.3, and rank 0 has --until = not given' "resume $work/uniform-1" \
  "resume $work/uniform-1 --until 0.3"
differ 'the folder = ' "resume $work/uniform-1" "resume $work/uniform-2-1"
differ 'it has --count = 3000, and rank 0 has --count = 1000' 'bench step --count 1000 --state clumped --solver fft' \
  'bench step --count 3000 --state clumped --solver fft'
differ 'it has --repeats = 2' 'bench step --count 1000 --state clumped --solver fft --repeats 1' \
  'bench step --count 1000 --state clumped --solver fft --repeats 2'
differ "'keeler info' is for one process" "$uniform" "info $work/uniform-1"
# one name, but different files in the two folders
cp "$(last_of "$work/uniform-1")" "$work/a/start.hdf"
cp "$(last_of "$work/uniform-4-2" | sed s/000002/000001/)" "$work/b/start.hdf"
differ "the content of '/proc/self/cwd/start.hdf' = KEELER-SEAL" "$uniform --from /proc/self/cwd/start.hdf" \
  "$uniform --from /proc/self/cwd/start.hdf"
printf '1.0\n2.0\n' >"$work/a/radii.txt"
printf '1.0\n2.5\n' >"$work/b/radii.txt"
sed 's|law = "equal", radius = 1.0|law = "file", path = "/proc/self/cwd/radii.txt"|' "$work/uniform.toml" >"$work/radii.toml"
differ "the content of '/proc/self/cwd/radii.txt'" "run $work/radii.toml -o $work/none" "run $work/radii.toml -o $work/none"
# Threads and the spelling of a path may differ between ranks.
(cd "$work" && OMP_NUM_THREADS=1 "$mpiexec" --oversubscribe --bind-to none "${transport[@]}" \
  -n 1 -wdir "$work/a" "$keeler" run "$work/uniform.toml" -o ../mixed --threads 1 : \
  -n 1 -wdir "$work" "$keeler" run uniform.toml -o mixed --threads 2 >"$work/out" 2>"$work/all") ||
  fail "own threads and paths: $(cat "$work/all")"
same "own threads and paths" "$work/uniform-1" "$work/mixed"

# A missing start
on_ranks 2 1 4 run "$work/wakes.toml" -o "$work/none" --from "$work/absent.hdf"
grep -qF "start.from names '$work/absent.hdf', which does not exist" "$work/err" || fail "absent: $(cat "$work/err")"

# Two builds do not start one run, in either order.
for programs in "$other_build : $keeler" "$keeler : $other_build"; do
  first=${programs%% : *} second=${programs##* : } code=0
  "$mpiexec" --oversubscribe "${transport[@]}" -n 1 "$first" run "$work/uniform.toml" -o "$work/none" : \
    -n 1 "$second" run "$work/uniform.toml" -o "$work/none" >"$work/all" 2>&1 || code=$?
  [ "$code" -eq 2 ] || fail "$programs: exit $code instead of 2: $(cat "$work/all")"
  [ ! -e "$work/none" ] || fail "$programs: something was written"
  if [ "$first" = "$other_build" ]; then # else the other program reports, and it prints nothing
    grep -qE '^keeler: rank 1 runs another build of Keeler' "$work/all" || fail "$programs: $(cat "$work/all")"
  fi
done

# A bench prints the gain by ranks and the cost of their communication.
on_ranks 2 1 0 bench step --count 3000 --state clumped --solver fft --repeats 1 --json
/usr/bin/python3 - "$work/out" <<'END' || fail "bench step: $(cat "$work/out")"
import json, sys
bench = json.load(open(sys.argv[1]))
assert bench["ranks"] == 2 and bench["speedup"]["step"] > 0 and bench["contacts"] > 0
exchange = bench["exchange"]
assert 0 < exchange["ns"] < bench["ns_per_particle_step"] and exchange["messages"] > 1 and exchange["bytes"] > 48
END

# A full disk, emulated by a limit on file size: exit 4, and the last checkpoint is good.
on_ranks 2 1 0 run "$work/wakes.toml" -o "$work/full" --set time.end=0.1
(
  ulimit -f 40
  on_ranks 2 1 4 resume "$work/full" --until 0.198
  report >/dev/null
) || fail "a full disk"
[ "$(grep -c '^keeler: ' "$work/err")" -eq 1 ] || fail "a full disk: not one line: $(cat "$work/err")"
grep -q "free some space, then continue with" "$work/err" || fail "a full disk: $(cat "$work/err")"
on_ranks 2 1 0 resume "$work/full" --until 0.198
same "after a full disk" "$work/wakes-1" "$work/full"

# A rank is killed: all end without success, and the run can be resumed from the last checkpoint.
"$mpiexec" -n 3 --oversubscribe -x OMP_NUM_THREADS=1 "$keeler" run "$work/wakes.toml" -o "$work/killed" \
  --set time.end=50 --set output.checkpoint_every=0.02 --set output.snapshot_every=0.1 >/dev/null 2>&1 &
launcher=$!
for _ in $(seq 600); do
  [ -n "$(newest_checkpoint "$work/killed" 2>/dev/null)" ] && break
  sleep 0.1
done
pkill -KILL -f -n -- "$keeler run $work/wakes.toml -o $work/killed" || fail "there was no rank to kill"
code=0
wait $launcher || code=$?
[ "$code" -ne 0 ] || fail "a killed rank: exit 0"
on_ranks 2 1 0 resume "$work/killed" --until 1
report
