#!/bin/bash
# tune.sh KEELER SOURCE_DIR: `keeler tune` finds settings within the tolerances and writes the resolved scene with them.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
scene=$work/scene.toml

# number NAME: prints x of the last line "NAME": x of the JSON in $work/out
number() { sed -nE "s/.*\"$1\": ([-+0-9.e]+).*/\1/p" "$work/out" | tail -n 1; }

# at_most NAME X Y: X is at most Y
at_most() { awk -v x="$2" -v y="$3" 'BEGIN { exit !(x != "" && x + 0 <= y + 0) }' || fail "$1: $2 is more than $3"; }

runs 0 tune "$scene" --orbits 0.3 --threads 2 --force-error 5e-3 --physics-error 0.2 --json
for name in keys particles orbits gravity kicks steps threads chosen solver settings error_rms ns_per_particle \
  kick_interval_orbits unresolved_contacts_share physics_error step_orbits drifts_per_kick contacts_per_particle_drift \
  processor_s_per_orbit speedup processor_s wall_s; do
  prints "tune as JSON" "\"$name\":"
done
at_most "the force error" "$(number error_rms)" 5e-3
at_most "the physics error" "$(number physics_error)" 0.2

runs 0 tune "$scene" --orbits 0.3 --threads 1 --quality fast -o "$work/tuned.toml"
prints "the file" "$work/tuned.toml"
accepts "the tuned scene" check "$work/tuned.toml"
grep -q '^# tune: ' "$work/tuned.toml" || fail "no comments: $(cat "$work/tuned.toml")"
grep -q '^title = "Small patch"' "$work/tuned.toml" || fail "another scene"
runs 0 run "$work/tuned.toml" -o "$work/run" --set time.end=0.1
runs 0 tune "$work/tuned.toml" --orbits 0.2 --threads 1 -o "$work/tuned.toml" --force --set time.end=1.2 # again, over itself
accepts "the scene tuned twice" check "$work/tuned.toml"
[ "$(grep -c '^kick_every' "$work/tuned.toml")" -eq 1 ] || fail "keys twice: $(cat "$work/tuned.toml")"
grep -q '^end = 1.2$' "$work/tuned.toml" || fail "the file lacks an override: $(cat "$work/tuned.toml")"

runs 0 tune "$source_dir/examples/equilibrium/scene.toml" --set particles.count=300 --set 'box.size=[40, 40]' \
  --orbits 0.5 --threads 1
no_controls "tune"
prints "without self-gravity" "time.step = "
grep -q "gravity" "$work/out" && fail "gravity in a scene that has none: $(cat "$work/out")"

refuses "a file that exists" "exists already" tune "$scene" -o "$work/tuned.toml"
refuses "a folder" "is a folder" tune "$scene" -o "$work"
refuses "no such quality" "best" tune "$scene" --quality best
refuses "a force error out of range" "is not a force error" tune "$scene" --force-error 2
refuses "no scene" "cannot be read" tune "$work/absent.toml"
refuses_with 4 "no folder" "$work/none" tune "$scene" -o "$work/none/new.toml"
report
