#!/bin/bash
# clumped.sh KEELER SOURCE_DIR: `generate --clumped` evolves a scene until its wakes have settled, prints the numbers of the
# criterion and stores them in the file, and a run continues from its state. (Tests with several threads:
# tests/unit/initial_conditions.)
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
grep -q ' orbits .* contrast .* viscosity changes by ' "$work/err" || fail "no progress: $(cat "$work/err")"

# recorded KEY: prints the number with this name in the file's record
runs 0 info "$work/one.hdf" --json
cp "$work/out" "$work/info.json"
recorded() { text "Clumping\/$1" "$work/info.json"; }
holds() { awk "BEGIN { exit !($2) }" || fail "$1: $2"; }
for quantity in loss_viscosity_m2_s wake_wavelength_m wake_radial_wavelength_m; do
  holds "$quantity settled" "$(recorded ${quantity}_change) <= $(recorded ${quantity}_tolerance)"
  mean="($(recorded $quantity) + $(recorded ${quantity}_before)) / 2"
  for error in error error_before; do
    holds "$quantity known" "$(recorded ${quantity}_$error) / ($mean) <= $(recorded ${quantity}_largest_error)"
  done
done
holds "typical" "$(recorded deviation) <= $(recorded largest_deviation)"
holds "wakes stand" "$(recorded standing) >= $(recorded least_standing)"
holds "two windows" "$(recorded orbits) + 1e-9 >= $(recorded first_orbit) + 2 * $(recorded window_orbits)"
holds "time of the state" "$(recorded orbits) == $(text time_orbits "$work/info.json")"
grep -q '"Clumping/history_work_m2": "\[' "$work/info.json" || fail "no history in the file"
cp "$work/printed" "$work/out"
prints "orbits" "settled after $(printf %.4g "$(recorded orbits)") orbits"
prints "viscosity" "viscosity from the loss of energy: $(printf %.4g "$(recorded loss_viscosity_m2_s)") ±"
prints "wake lengths" "wake length lambda_x: $(printf %.4g "$(recorded wake_radial_wavelength_m)") ±"
prints "criterion" "(at most $(printf %.1f "$(awk "BEGIN { print 100 * $(recorded wake_wavelength_m_tolerance) }")") %)"
runs 0 info "$work/one.hdf"
prints "info in text" "Clumping/loss_viscosity_m2_s"
runs 0 analyze "$work/one.hdf"
grep -qE '^wakes: pitch +[0-9.]+ degrees' "$work/out" || fail "trailing wakes: $(cat "$work/out")"

for threads in 1 2; do
  runs 0 run "$work/scene.toml" --from "$work/one.hdf" -o "$work/run$threads" --threads $threads
done
same_state "run --from, 1 and 2 threads" "$work/run1" "$work/run2"
[ "$(text time_orbits "$work/run1/summary.json")" = 0.05 ] || fail "a run from a clumped state does not begin at 0"
runs 0 info "$work/run1/snap_000000.hdf"
grep -q Clumping "$work/out" && fail "a snapshot of a run has the record of its start"

# A patch that does not clump, or not in time, leaves no file.
nothing_left() { [ -e "$work/none.hdf" ] && fail "$1: left a file behind"; }
refuses_with 1 "too light" "no wakes in the patch" "${clump[@]}" -o "$work/none.hdf" \
  --set particles.density=110 --set 'box.size=[60,60]' --most-orbits 9
nothing_left "too light"
refuses_with 1 "not by then" "did not settle in 9 orbits" "${clump[@]}" -o "$work/none.hdf" --most-orbits 9 \
  --set particles.seed=2
nothing_left "not settled"
refuses "a limit too low" "allow at least 9" "${clump[@]}" -o "$work/none.hdf" --most-orbits 8
refuses "a limit of nothing" "requires --clumped" generate "$work/scene.toml" -o "$work/none.hdf" --most-orbits 9
refuses "too few" "wakes would not be visible" "${clump[@]}" -o "$work/none.hdf" --set particles.count=5 --set 'box.size=[60,60]'
sed '/^\[gravity\]/,/^kick/d' "$work/scene.toml" >"$work/light.toml"
refuses "no gravity" "add [gravity]" generate "$work/light.toml" --clumped -o "$work/none.hdf"
refuses "a state that exists" "--force" "${clump[@]}" -o "$work/one.hdf"
nothing_left "refused"

# A stop, long before a patch of this size can settle.
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
