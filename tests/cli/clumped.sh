#!/bin/bash
# clumped.sh KEELER SOURCE_DIR: `generate --clumped` evolves a scene until its wakes have settled, says by which numbers,
# keeps them in the file, is the same for any number of threads, and its state is where a run goes on.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
cat >"$work/scene.toml" <<END
title = "Small patch that clumps within a second"
[planet]
preset = "saturn-a-ring"
[box]
size_in_wavelengths = [2, 2]
[particles]
optical_depth = 0.5
density = 450.0
velocity_dispersion = 2.5
sizes = { law = "equal", radius = 1.0 }
[gravity]
opening_angle = 0.8
kick_every = 5
[time]
step = 2e-3
end = 0.05
END
clump=(generate "$work/scene.toml" --clumped)

runs 0 "${clump[@]}" -o "$work/one.hdf" --threads 1
cp "$work/out" "$work/printed"
grep -q ' orbits .* amplitude .* changes by ' "$work/err" || fail "no progress: $(cat "$work/err")"
runs 0 "${clump[@]}" -o "$work/two.hdf" --threads 2
for dataset in Coordinates Velocities Masses ParticleIDs; do
  same_bytes "1 and 2 threads" "$work/one.hdf" "$work/two.hdf" "/PartType1/$dataset"
done

# recorded KEY: the number of this name in the record of the file
runs 0 info "$work/one.hdf" --json
cp "$work/out" "$work/info.json"
recorded() { text "Clumping\/$1" "$work/info.json"; }
holds() { awk "BEGIN { exit !($2) }" || fail "$1: $2"; }
holds "settled" "$(recorded change) <= $(recorded largest_change) && $(recorded deviation) <= $(recorded largest_deviation)"
holds "two windows" "$(recorded orbits) >= 2 * $(recorded window_orbits)"
holds "time of the state" "$(recorded orbits) == $(text time_orbits "$work/info.json")"
grep -q '"Clumping/history_amplitude": "\[' "$work/info.json" || fail "no history in the file"
cp "$work/printed" "$work/out"
prints "orbits" "settled after $(printf %.4g "$(recorded orbits)") orbits"
prints "amplitude" "amplitude $(printf %.3g "$(recorded amplitude)") over the last orbit"
prints "criterion" "(at most $(printf %g "$(awk "BEGIN { print 100 * $(recorded largest_change) }")") %)"
runs 0 info "$work/one.hdf"
prints "info in text" "Clumping/amplitude"
runs 0 analyze "$work/one.hdf"
prints "wakes" "trailing"

for threads in 1 2; do
  runs 0 run "$work/scene.toml" --from "$work/one.hdf" -o "$work/run$threads" --threads $threads
done
same_state "run --from, 1 and 2 threads" "$work/run1" "$work/run2"
[ "$(text time_orbits "$work/run1/summary.json")" = 0.05 ] || fail "a run from a clumped state does not begin at 0"
runs 0 info "$work/run1/snap_000000.hdf"
grep -q Clumping "$work/out" && fail "a snapshot of a run has the record of its start"

# What does not clump, or is not let, leaves nothing behind.
nothing_left() { [ -e "$work/none.hdf" ] && fail "$1: left a file behind"; }
refuses_with 1 "too light" "no wakes stand in the patch" "${clump[@]}" -o "$work/none.hdf" \
  --set particles.density=110 --set 'box.size=[60,60]'
nothing_left "too light"
refuses "too few" "wakes could not be seen" "${clump[@]}" -o "$work/none.hdf" --set particles.count=5 --set 'box.size=[60,60]'
sed '/^\[gravity\]/,/^kick/d' "$work/scene.toml" >"$work/light.toml"
refuses "no gravity" "add [gravity]" generate "$work/light.toml" --clumped -o "$work/none.hdf"
refuses "a state that exists" "--force" "${clump[@]}" -o "$work/one.hdf"
nothing_left "refused"

# A stop, long before a patch of this size can have settled.
for signal in INT TERM; do
  : >"$work/err"
  "$keeler" "${clump[@]}" -o "$work/none.hdf" --set 'box.size_in_wavelengths=[8,8]' >"$work/out" 2>"$work/err" &
  process=$!
  until [ -s "$work/err" ] || ! kill -0 "$process" 2>/dev/null; do sleep 0.01; done
  kill "-$signal" "$process"
  code=0
  wait "$process" || code=$?
  [ "$code" -eq 1 ] || fail "$signal: exit $code instead of 1"
  one_line "$signal" "no state is written"
  [ -s "$work/out" ] && fail "$signal: printed $(cat "$work/out")"
  nothing_left "$signal"
done

report
