#!/bin/bash
# invariants.sh KEELER SOURCE_DIR: what breaks ends a run with exit code 3, one line and a state that can be looked at;
# `--check` looks at each step, and changes no bit.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene

# A sound run.
runs 0 run "$work/scene.toml" --set time.end=0.2 -o "$work/plain"
runs 0 run "$work/scene.toml" --set time.end=0.1 -o "$work/sound" --check --threads 2
runs 0 resume "$work/sound" --until 0.2 --check
[ "$(state_hash "$work/sound")" = "$(state_hash "$work/plain")" ] || fail "--check changes the state"

# looked_at NAME FOLDER: the folder has one broken state, which the last message names, and commands take it
looked_at() {
  local broken=("$2"/broken_*.hdf)
  if [ ! -f "${broken[0]}" ] || [ ${#broken[@]} -ne 1 ]; then
    fail "$1: not one broken state"
    return
  fi
  sed -i '$!d' "$work/err" # what a start from a file drops is told before
  one_line "$1" "the state is in '${broken[0]}'"
  runs 0 info "${broken[0]}"
  prints "$1: info" "snapshot"
  runs 0 render "${broken[0]}" -o "$work/broken.png"
  runs 0 analyze "${broken[0]}"
  runs 0 info "$2"
  prints "$1: info of the folder" "broken"
  grep -q '"event":"broken"' "$2/log.jsonl" || fail "$1: the log does not tell"
  [ -e "$2/summary.json" ] && fail "$1: there is a summary"
}

# Long steps and a finder that then loses contacts: nothing is wrong with the numbers, but particles overlap.
lossy=(--set collisions.finder=newton-cubic --set time.step=0.05)
runs 3 run "$work/scene.toml" "${lossy[@]}" -o "$work/lossy" --check
grep -qE 'no overlap: particles [0-9]+ and [0-9]+ overlap by .* of their radius sum' "$work/err" ||
  fail "the lossy finder: $(tail -n 1 "$work/err")"
looked_at "the lossy finder" "$work/lossy"
refuses_with 3 "a run from the broken state" "overlap" run "$work/scene.toml" -o "$work/again" --from "$work"/lossy/broken_*.hdf
refuses_with 4 "no checkpoint" "no checkpoint" resume "$work/lossy"
runs 0 run "$work/scene.toml" --set time.end=0.02 -o "$work/lossy" --force
ls "$work"/lossy/broken_*.hdf 2>/dev/null && fail "--force leaves the broken state of the run before"

# An event storm: a closed row of elastic spheres without gaps. What hits it runs around it for ever in no time.
cat >"$work/row.csv" <<END
x y z vx vy vz r
0 -3 0 0 2e-4 0 1
0 -1 0 0 0 0 1
0 1 0 0 0 0 1
END
cat >"$work/row.toml" <<END
planet.orbital_frequency = 2e-4
box.size = [20, 6]
particles.density = 500.0
collisions.restitution = { law = "constant", value = 1.0 }
time = { step = 1e-3, end = 0.01 }
END
runs 0 generate "$work/row.toml" --from-table "$work/row.csv" -o "$work/row.hdf"
runs 3 run "$work/row.toml" --set particles.count=3 --from "$work/row.hdf" -o "$work/storm" --threads 2
grep -q 'an event storm' "$work/err" || fail "no storm: $(tail -n 1 "$work/err")"
looked_at "an event storm" "$work/storm"
refuses_with 4 "no checkpoint of a storm" "no checkpoint" resume "$work/storm"
report
