#!/bin/bash
# starts.sh KEELER SOURCE_DIR: initial states do not depend on the number of threads, are flat-topped where a Gaussian layer
# would be too dense, are refused with the nearest possible scene, and are stopped at once without leaving files.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
cat >"$work/scene.toml" <<END
[planet]
orbital_frequency = 1.95e-4
[box]
size = [60, 60]
[particles]
optical_depth = 0.8
density = 900.0
sizes = { law = "power", exponent = 3.0, min = 0.2, max = 4.0 }
[time]
step = 1e-3
end = 0.002
END

for threads in 1 3; do
  accepts "$threads threads" generate "$work/scene.toml" -o "$work/$threads.hdf" --threads $threads
done
same_bytes "1 and 3 threads" /PartType1 "$work/1.hdf" "$work/3.hdf"
runs 0 analyze "$work/1.hdf"
prints "overlap" "largest overlap                    0 of"

sed -e 's/^sizes = .*/sizes = { law = "equal", radius = 1.0 }/' -e 's/_depth = .*/_depth = 3.0/' "$work/scene.toml" \
  >"$work/dense.toml"
notice="the start has a flat-topped layer with a mid-plane filling factor of 0.55"
runs 0 check "$work/dense.toml"
prints "check" "$notice"
prints "check" "mid-plane filling at the start     0.55"
runs 0 generate "$work/dense.toml" -o "$work/dense.hdf"
grep -qF "keeler: note: $notice" "$work/err" || fail "generate: no notice: $(cat "$work/err")"
runs 0 run "$work/dense.toml" -o "$work/run"
grep -qF "$notice" "$work/err" || fail "run: no notice: $(cat "$work/err")"
prints "split" "  start                            "
refuses "too dense" "raise velocity_dispersion to at least 3.44 or lower the optical depth from 4 to at most 3.05" \
  generate "$work/dense.toml" --set particles.optical_depth=4.0 -o "$work/none.hdf"

refuses "modes that make streamlines cross" "sum up to 1.1 (at 1 streamlines cross)" \
  generate "$work/scene.toml" --set 'particles.modes={outward=[[1,0.6,0]], standing=[[2,0.5,0]]}' -o "$work/none.hdf"
refuses "a mode that does not fit the box" "row 1 of particles.modes.outward has waves: 0" \
  generate "$work/scene.toml" --set 'particles.modes.outward=[[0,0.1,0]]' -o "$work/none.hdf"

# Density patterns, and a fraction of a snapshot's particles.
runs 0 generate "$work/scene.toml" --set 'particles.wake={contrast=0.5, wavelength=30, pitch=25}' -o "$work/wake.hdf"
grep -qF "keeler: note: the wake has a wavelength of 26.83 m and a pitch of 26.57 degrees (2 x 1 waves fit the box)" "$work/err" ||
  fail "a wake: $(cat "$work/err")"
refuses "a step beyond the box" "particles.density_step.between is [-10, 50] (it must be two rising x within the box, from -30 to 30" \
  generate "$work/scene.toml" --set 'particles.density_step={between=[-10,50], factor=2.0}' -o "$work/none.hdf"

# Aggregates.
aggregate() { echo "particles.aggregate=[{ count = $1, filling_factor = $2, position = [10, 0, 0] }]"; }
accepts "an aggregate" generate "$work/scene.toml" --set "$(aggregate 200 0.5)" -o "$work/pile.hdf"
runs 0 analyze "$work/pile.hdf"
prints "an aggregate overlaps nothing" "largest overlap                    0 of"
runs 0 generate "$work/scene.toml" --set particles.density=3000 --set "$(aggregate 200 0.5)" -o "$work/heavy.hdf"
runs 0 check "$work/scene.toml" --set "start.from='$work/heavy.hdf'" --set 'gravity={solver="direct",kick_every=20}'
prints "check of a start from a file" "Hill parameter r_h                 1.22"
prints "check of a start from a file" "  why                              aggregates last at r_h 1.22"
prints "check of a start from a file" "note: kicks are 0.02 orbits apart: aggregates form at r_h 1.2, cannot rest"
runs 0 check "$work/scene.toml" --set "$(aggregate 200 0.5)"
prints "check" "aggregate                          id "
refuses "too full an aggregate" "particles.aggregate[1]: 12 particles cannot be packed at random to a filling of 0.64" \
  generate "$work/scene.toml" --set "$(aggregate 12 0.64)" --set particles.sizes.min=3.9 -o "$work/none.hdf"
refuses "an aggregate of more than there are" "is too large (the scene has" \
  generate "$work/scene.toml" --set "$(aggregate 100000000 0.5)" -o "$work/none.hdf"
refuses "an aggregate wider than the box" "across (more than one side of the box" \
  generate "$work/scene.toml" --set "$(aggregate 200 0.0001)" -o "$work/none.hdf"
refuses "an aggregate in a moonlet" "particles.aggregate[1] and moonlet[1] overlap" generate "$work/scene.toml" \
  --set "$(aggregate 200 0.5)" --set 'moonlet=[{ radius = 11.0, density = 900.0 }]' -o "$work/none.hdf"

# The treatment of contacts at rest follows from the particles, whatever their source.
cat >"$work/layer.toml" <<END
[planet]
preset = "saturn-a-ring"
[box]
size = [25, 25]
[particles]
optical_depth = 2.0
density = 600.0
velocity_dispersion = 8.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = "direct"
kick_every = 5
[time]
step = 1e-3
end = 0.01
END
# rests WORD [OPTION]...: in a fresh run, one from its first snapshot, one from a table of that, and one that goes on
rests() {
  local word=$1 folder
  shift
  runs 0 check "$work/layer.toml" "$@"
  prints "check" "contacts at rest                   $word"
  runs 0 run "$work/layer.toml" "$@" -o "$work/rests" --force
  local first=$work/rests/snap_000000.hdf
  runs 0 check "$work/layer.toml" "$@" --set "start.from='$first'"
  prints "check of a snapshot" "contacts at rest                   $word"
  runs 0 run "$work/layer.toml" "$@" --from "$first" -o "$work/rests-from" --force
  runs 0 resume "$work/rests-from" --until 0.02
  runs 0 convert "$first" --to csv -o "$work/first.csv" --force
  runs 0 generate "$work/layer.toml" "$@" --from-table "$work/first.csv" -o "$work/table.hdf" --force
  runs 0 run "$work/layer.toml" "$@" --from "$work/table.hdf" -o "$work/rests-table" --force
  for folder in rests rests-from rests-table; do
    grep -qx "resting_contacts = \"$word\"" "$work/$folder/scene.toml" || fail "$folder $*: not $word"
  done
}
rests bounced --set particles.density=204
rests carried --set particles.density=597
rests carried --set particles.density=597 --set gravity.kick_every=1 --set time.step=2e-4 # whatever the kick interval

printf '[planet]\norbital_frequency = 1.95e-4\n[start]\nfrom = "1.hdf"\n[time]\nstep = 1e-3\nend = 0.002\n' >"$work/share.toml"
for share in 1.0 0.5; do
  runs 0 generate "$work/share.toml" --set start.keep_fraction=$share -o "$work/kept-$share.hdf"
  sed -nE 's/ particles? in .*//p' "$work/out" >"$work/kept-$share"
done
same_bytes "a share of 1" /PartType1/ParticleIDs "$work/1.hdf" "$work/kept-1.0.hdf"
[ $((2 * $(cat "$work/kept-0.5"))) -lt $(($(cat "$work/kept-1.0") * 6 / 5)) ] || fail "half: $(cat "$work/kept-0.5")"
[ $((2 * $(cat "$work/kept-0.5"))) -gt $(($(cat "$work/kept-1.0") * 4 / 5)) ] || fail "half: $(cat "$work/kept-0.5")"
refuses "no share" "start.keep_fraction is 0" generate "$work/share.toml" --set start.keep_fraction=0.0 -o "$work/none.hdf"

# A stop while an initial state is made for more than ten seconds. The program handles signals once it catches TERM (bit 14).
catches_signals() { ((0x$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null || echo 0) & 0x4000)); }
stops() {
  local name=$1 signal=$2 process code=0
  shift 2
  "$keeler" "$@" --set particles.optical_depth=0.5 --set 'box.size=[1500,1500]' >"$work/out" 2>"$work/err" &
  process=$!
  until catches_signals $process || ! kill -0 $process 2>/dev/null; do sleep 0.01; done
  sleep 0.5
  kill "-$signal" $process
  wait $process || code=$?
  [ "$code" -eq 1 ] || fail "$name, $signal: exit $code instead of 1"
  one_line "$name, $signal" "stopped before the"
  [ -e "$work/stopped" ] && fail "$name, $signal: left something behind"
}
for signal in INT TERM; do
  stops generate $signal generate "$work/scene.toml" -o "$work/stopped"
  stops run $signal run "$work/scene.toml" -o "$work/stopped"
done

report
