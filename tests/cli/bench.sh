#!/bin/bash
# bench.sh KEELER SOURCE_DIR: the numbers that benches print, on the smallest states.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
number='-?[0-9.]+(e[-+]?[0-9]+)?'

# has_numbers WHAT KEY...: the JSON that was printed has these keys, with numbers
has_numbers() {
  local key what=$1
  shift
  for key in "$@"; do
    grep -qE "\"$key\": $number,?$" "$work/out" || fail "$what: no $key in: $(cat "$work/out")"
  done
}

runs 0 bench drift --count 500 --step 2e-3 --repeats 2 --json
has_numbers "bench" ns_per_particle_step cost_per_orbit_us ns_per_collision ns_per_call pairs_per_particle \
  survivors_per_particle bytes_per_particle collisions_per_particle_orbit dispersion_r_omega advance build reject solve \
  events line_ns pair_ns
grep -q speedup "$work/out" && fail "bench: a speedup on one thread in: $(cat "$work/out")"
runs 0 bench drift --count 500 --repeats 1 --finder original --all-pairs --threads 2
prints "bench" "per particle and step              "
prints "bench" "speedup: events                    "
runs 0 bench drift --count 500 --repeats 1 --threads 2 --json
has_numbers "bench on two threads" step events pair
runs 0 bench drift --count 400 --optical-depth 0.02 --sizes moonlet --repeats 1 --json
grep -qF '"sizes": "moonlet"' "$work/out" || fail "bench: no moonlet in: $(cat "$work/out")"
refuses "too few for a moonlet" "raise --count" bench drift --count 500 --sizes moonlet
refuses "unknown sizes" "--sizes" bench drift --sizes huge
refuses "an unknown finder" "'guess'" bench drift --finder guess
refuses "bench without a kernel" "needs a subcommand: drift, gravity, step" bench
refuses "no particles" "--count" bench drift --count 0

runs 0 bench gravity --count 100 --state uniform --repeats 1 --json
has_numbers "bench gravity" error_rms error_p999 error_x error_y error_z error_edge edge_pull net_force ns_per_particle \
  threads count sample preparation_s
for row in '"solver": "direct"' '"solver": "tree"' '"settings": "opening_angle 0.6"' '"state": "uniform"'; do
  grep -qF "$row" "$work/out" || fail "bench gravity: no $row in: $(cat "$work/out")"
done
errors() { grep -E '"(error|edge|net)_' "$work/out"; }
runs 0 bench gravity --count 100 --state clumped --repeats 1 --json --solver tree
errors >"$work/one"
grep -q '"solver": "direct"' "$work/out" && fail "bench gravity --solver tree has other solvers"
runs 0 bench gravity --count 100 --state clumped --repeats 1 --json --solver tree --threads 2
errors | cmp - "$work/one" || fail "errors depend on the threads"
runs 0 bench gravity --count 100 --state uniform --repeats 1 --solver tree
prints "bench gravity as text" "edge pull"
refuses "an unknown solver" "--solver" bench gravity --solver guess
refuses "an unknown state" "--state" bench gravity --state lumpy

runs 0 bench step --count 100 --state clumped --repeats 1 --kick-every 3 --json
has_numbers "bench step" ns_per_particle_step drift advance gravity kick build reject solve events ns_drift_per_collision drift_over_pair \
  ns_events_per_collision collisions_per_particle_step contacts_per_particle_step pairs_per_particle survivors_per_particle \
  contacts lists_made deferred bytes_per_particle line_ns pair_ns dispersion_r_omega kick_every count steps preparation_s
grep -qF '"state": "clumped"' "$work/out" || fail "bench step: no state in: $(cat "$work/out")"
grep -q speedup "$work/out" && fail "bench step: a speedup on one thread in: $(cat "$work/out")"
[ $(($(sed -nE 's/^  "steps": ([0-9]+)$/\1/p' "$work/out") % 3)) -eq 0 ] || fail "bench step: no whole kick intervals"
runs 0 bench step --count 100 --state uniform --repeats 1
prints "bench step of a uniform state" "state                              uniform"
refuses "an unknown state of a step" "--state" bench step --state lumpy
refuses "no interval" "--kick-every" bench step --kick-every 0

small_scene
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.01 --set gravity.kick_every=5 --set gravity.opening_angle=0.5
runs 0 bench step --from "$work/run/snap_000001.hdf" --repeats 1
for words in "collisions per particle and step   " "contacts per particle and step     " "  drift: build  " \
  "drift over a pair's time" "particles                          400" "solver                             tree" "opening_angle 0.5" \
  "steps per kick                     5"; do
  prints "bench step of a snapshot as text" "$words"
done
runs 0 bench step --from "$work/run/snap_000001.hdf" --repeats 1 --kick-every 2 --solver mesh --threads 2
prints "bench step on two threads" "speedup: gravity                   "
prints "bench step with another solver" "mesh_spacing 1.6"
runs 0 bench step --from "$work/run/snap_000001.hdf" --repeats 1 --threads 2 --json
sed -n '/"speedup"/,/}/p' "$work/out" >"$work/speedup"
for key in step drift events gravity pair; do
  grep -qE "\"$key\": $number,?$" "$work/speedup" || fail "bench step: no speedup.$key in: $(cat "$work/out")"
done
grep -qF "\"from\": \"$work/run/snap_000001.hdf\"" "$work/out" || fail "bench step: no file in: $(cat "$work/out")"
refuses "a number of particles for a snapshot" "--count" bench step --count 100 --from "$work/run/snap_000001.hdf"
refuses "a state for a snapshot" "--state" bench step --state uniform --from "$work/run/snap_000001.hdf"
refuses_with 4 "no such snapshot" "absent.hdf" bench step --from "$work/absent.hdf"
refuses_with 4 "no snapshot" "'$work/scene.toml' is no snapshot: it does not begin as HDF5 files do" bench step --from "$work/scene.toml"
refuses_with 4 "a checkpoint" "is not a Keeler snapshot" bench step --from "$(newest_checkpoint "$work/run")"
sed -i '/^\[gravity\]/,/^solver/d' "$work/scene.toml"
runs 0 generate "$work/scene.toml" -o "$work/free.hdf"
refuses "a snapshot without gravity" "has no [gravity]" bench step --from "$work/free.hdf"

report
