#!/bin/bash
# hardening.sh KEELER SOURCE_DIR: faults of the environment of a run, and absurd input. None may crash or hang the program:
# each case ends with its exit code, and a healthy run continues.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.3/' "$work/scene.toml"
runs 0 run "$work/scene.toml" -o "$work/whole"
expected=$(state_hash "$work/whole")

# ended NAME FOLDER CODE EXPECTED-CODE: the codes are equal, and the run in the folder is complete
ended() {
  [ "$3" -eq "$4" ] || fail "$1: exit $3 instead of $4"
  [ "$(text finished "$2/summary.json")" = true ] || fail "$1: not finished"
  [ "$(state_hash "$2")" = "$expected" ] || fail "$1: another state"
}

# Standard error: no process reads progress and notices. There is one notice: the end is not a whole number of kicks.
noisy=(run "$work/scene.toml" --set time.end=0.3001)
"$keeler" "${noisy[@]}" -o "$work/err-closed" >"$work/out" 2>&-
ended "closed standard error" "$work/err-closed" $? 0
"$keeler" "${noisy[@]}" -o "$work/err-full" >"$work/out" 2>/dev/full
ended "full standard error" "$work/err-full" $? 0
mkfifo "$work/pipe"
true <"$work/pipe" &
"$keeler" "${noisy[@]}" -o "$work/err-broken" >"$work/out" 2>"$work/pipe"
ended "broken pipe on standard error" "$work/err-broken" $? 0
"$keeler" check "$work/absent.toml" >"$work/out" 2>&-
code=$?
[ $code -eq 2 ] || fail "an error that nobody reads: exit $code"

# Standard output: the results in files are complete; the exit code shows that the printed ones are not.
"$keeler" run "$work/scene.toml" -o "$work/out-closed" >&- 2>"$work/err"
ended "closed standard output" "$work/out-closed" $? 4
one_line "closed standard output" "cannot write to standard output: Bad file descriptor"
true <"$work/pipe" &
"$keeler" run "$work/scene.toml" -o "$work/out-broken" >"$work/pipe" 2>"$work/err"
ended "broken pipe on standard output" "$work/out-broken" $? 4
one_line "broken pipe on standard output" "cannot write to standard output: Broken pipe"
for arguments in --help "check --defaults" "run $work/scene.toml -o $work/out-full"; do # more than a buffer, and less
  # shellcheck disable=SC2086 # several words
  "$keeler" $arguments >/dev/full 2>"$work/err"
  code=$?
  [ $code -eq 4 ] || fail "$arguments into a full device: exit $code"
  one_line "$arguments into a full device" "cannot write to standard output: No space left on device"
done

# Invalid numbers of threads.
refuses "too many threads" "a number of threads from 1 to 1024" run "$work/scene.toml" -o "$work/none" --threads 100000
OMP_NUM_THREADS=99999999 refuses "too many threads in the environment" "OMP_NUM_THREADS" check "$work/scene.toml"

# Scenes with finite but absurd values: each quantity has its range. Steps of these scenes once never ended.
for absurd in planet.orbital_frequency=1e-12 particles.density=1e12 particles.velocity_dispersion=1e6 \
  particles.sizes.radius=1e-9 'box.size=[1e9,1e9]' 'box.size=[2,1e6]' time.step=1e-12; do
  refuses "$absurd" "${absurd%%=*}" run "$work/scene.toml" -o "$work/none" --set "$absurd"
done
sed 's/^preset = .*/orbital_frequency = 1e-8/' "$work/scene.toml" >"$work/slow-orbit.toml"
refuses_with 3 "a step in which all falls together" "in one step" run "$work/slow-orbit.toml" -o "$work/fast"

# Absurd values in a start file: a coordinate of 1e9 m, a mass of 1e18 kg.
runs 0 generate "$work/scene.toml" -o "$work/packed.hdf"
h5repack -f NONE -l CONTI "$work/packed.hdf" "$work/start.hdf"
runs 0 run "$work/scene.toml" --from "$work/start.hdf" -o "$work/from" --set time.end=0.002

# absurd_start NAME DATASET BYTES WORDS: a start with these bytes as first number of the dataset is refused with the words
absurd_start() {
  local place
  place=$(h5dump -p -H -d "/PartType1/$2" "$work/start.hdf" | sed -nE 's/^ *OFFSET ([0-9]+)/\1/p')
  cp "$work/start.hdf" "$work/absurd.hdf"
  # shellcheck disable=SC2059 # the format is the bytes
  printf "$3" | dd of="$work/absurd.hdf" bs=1 seek="$place" conv=notrunc status=none
  runs 3 run "$work/scene.toml" --from "$work/absurd.hdf" -o "$work/none"
  grep -qF "keeler: particle 0 of '$work/absurd.hdf' has $4" "$work/err" || fail "$1: $(cat "$work/err")"
}
absurd_start "a place" Coordinates '\0\0\0\0\x65\xcd\xcd\x41' "a coordinate (m) of 1e9"
absurd_start "a mass" Masses '\0\xc8\x4e\x67\x6d\xc1\xab\x43' "a density (kg/m^3, by its mass and radius) of 2.39e17"
[ -e "$work/none" ] && fail "an absurd scene left a folder behind"

# Signals. Each step of this scene takes minutes: long steps, and hot particles in a box that they cross several times.
slow=(run "$work/scene.toml" --set particles.velocity_dispersion=900 --set particles.count=10000
  --set 'box.size=[300,300]' --set time.step=0.03 --set time.end=3 --set output.snapshot_every=0
  --set output.checkpoint_every=0)

# signalled_after SECONDS SIGNALS FOLDER FILES: starts the slow run and sends this number of signals, 0.3 s apart, SECONDS
# after one of the files exists; sets $code and $took
signalled_after() {
  "$keeler" "${slow[@]}" -o "$3" >"$work/out" 2>"$work/err" &
  local process=$! signals=$2
  until compgen -G "$3/$4" >"$work/there" || ! kill -0 "$process" 2>/dev/null; do sleep 0.05; done
  sleep "$1"
  SECONDS=0
  for ((; signals > 0; --signals)); do
    kill -INT "$process" 2>/dev/null
    sleep 0.3
  done
  code=0
  wait "$process" || code=$?
  took=$SECONDS
}

# gave_up NAME MIN MAX: the run ended with exit code 1 after MIN to MAX seconds
gave_up() {
  [ "$code" -eq 1 ] || fail "$1: exit $code"
  [ "$took" -ge "$2" ] || fail "$1: after $took s already"
  [ "$took" -le "$3" ] || fail "$1: only after $took s"
}
signalled_after 1 1 "$work/slow" snap_000000.hdf
gave_up "a step without end" 4 20
one_line "a step without end" "before there was a checkpoint"
signalled_after 1 2 "$work/slower" snap_000000.hdf
gave_up "a second signal" 0 4
one_line "a second signal" "before there was a checkpoint"

# With a checkpoint: steps of one second, one checkpoint each, two signals at once. Repeated if they came between steps.
slow+=(--set particles.count=3500 --set 'box.size=[172,172]' --set time.step=0.01 --set output.checkpoint_every=0.01)
for ((try = 0; try < 10; ++try)); do
  rm -rf "$work/kept"
  signalled_after 1 2 "$work/kept" 'checkpoint_*.h5'
  [ $code -eq 75 ] || fail "a step given up after a checkpoint: exit $code: $(cat "$work/err")"
  grep -q "given up" "$work/err" && break
done
step=$(sed -nE 's/.*the checkpoint of step ([0-9]+) is intact.*keeler resume .*/\1/p' "$work/err")
runs 0 info "$(newest_checkpoint "$work/kept")" --json
[ "$(text time_orbits "$work/out" | awk -v s="$step" '{ print ($1 - 0.01 * s) ^ 2 < 1e-12 }')" = 1 ] ||
  fail "the checkpoint of step '$step' is of orbit $(text time_orbits "$work/out")"
runs 0 resume "$work/kept" --until "$(awk -v s="$step" 'BEGIN { print 0.01 * (s + 1) }')"

# Waiting threads sleep where the environment says nothing of it.
env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose "$keeler" --version >"$work/out" 2>"$work/err"
grep -q "OMP_WAIT_POLICY *= *'PASSIVE'" "$work/err" || fail "threads spin: $(grep WAIT "$work/err")"

# Little memory: one line wherever it runs out, including the start of HDF5 and OpenMP's threads.
limited() { # KIB ARGUMENT...: as runs, whatever the code is
  (
    ulimit -v "$1"
    shift
    exec "$keeler" "$@" >"$work/out" 2>"$work/err"
  )
}
export OMP_WAIT_POLICY=passive
least=10000
until { limited $least --version; } 2>/dev/null; do least=$((least + 200)); done
for ((more = 0; more <= 9600; more += 300)); do
  code=0
  OMP_NUM_THREADS=1 limited $((least + more)) run "$work/scene.toml" -o "$work/tight" --force -q --set time.end=0.02 || code=$?
  [ $code -eq 0 ] && break
  [ $code -eq 1 ] || [ $code -eq 4 ] || fail "$((least + more)) KiB of memory: exit $code: $(cat "$work/err")"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "$((least + more)) KiB of memory: not one line: $(cat "$work/err")"
done
code=0
limited 400000 run "$work/scene.toml" -o "$work/tight" --force -q --threads 100 || code=$?
[ $code -eq 1 ] || fail "no memory for threads: exit $code: $(cat "$work/err")"
one_line "no memory for threads" "the system cannot start 100 threads"

# The first signal interrupts the making of an initial state.
"$keeler" generate "$work/scene.toml" -o "$work/large.hdf" --set 'box.size=[4000,4000]' --set particles.count=2500000 \
  >"$work/out" 2>"$work/err" &
process=$!
sleep 2
SECONDS=0
kill -INT $process
code=0
wait $process || code=$?
took=$SECONDS
gave_up "a start given up" 0 5
one_line "a start given up" "no state is written"
[ -e "$work/large.hdf" ] && fail "a start given up left a file"

report
