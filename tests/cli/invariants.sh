#!/bin/bash
# invariants.sh KEELER SOURCE_DIR: a broken invariant ends a run with exit code 3, one line and a file with the broken state;
# `--check` checks each step, and changes no bit.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene

# A run without faults.
runs 0 run "$work/scene.toml" --set time.end=0.2 -o "$work/plain"
runs 0 run "$work/scene.toml" --set time.end=0.1 -o "$work/sound" --check --threads 2
runs 0 resume "$work/sound" --until 0.2 --check
[ "$(state_hash "$work/sound")" = "$(state_hash "$work/plain")" ] || fail "--check changes the state"

# looked_at NAME FOLDER: the folder has one broken state, which the last message names, and commands can read it
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

# Long steps, in which a finder loses contacts: all numbers are finite, but particles overlap.
lossy=(--set collisions.finder=newton-cubic --set time.step=0.05 --set output.checkpoint_every=0)
runs 3 run "$work/scene.toml" "${lossy[@]}" -o "$work/lossy" --check
grep -qE 'no overlap: particles [0-9]+ and [0-9]+ overlap by .* of their radius sum' "$work/err" ||
  fail "the lossy finder: $(tail -n 1 "$work/err")"
looked_at "the lossy finder" "$work/lossy"
refuses_with 3 "a run from the broken state" "overlap" run "$work/scene.toml" -o "$work/again" --from "$work"/lossy/broken_*.hdf
refuses_with 4 "no checkpoint" "no checkpoint" resume "$work/lossy"
runs 0 run "$work/scene.toml" --set time.end=0.02 -o "$work/lossy" --force
ls "$work"/lossy/broken_*.hdf 2>/dev/null && fail "--force leaves the broken state of the run before"

# An event storm: a closed row of elastic spheres without gaps. An impact travels around it forever in zero time.
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
[ -f "$work/storm/broken_000000.hdf" ] || fail "not in the first step: $(cd "$work/storm" && echo broken_*)"
refuses_with 4 "no checkpoint of a storm" "no checkpoint" resume "$work/storm"

# A resumed run, and a check that is always on: the energy budget before each row. Only the energy sums of the checkpoint are
# changed, and it is sealed again.
runs 0 run "$work/scene.toml" --set time.end=0.1 -o "$work/books"
/usr/bin/python3 -B "$source_dir/tests/cli/change_checkpoint.py" "$(newest_checkpoint "$work/books")" collision_energy_lost 1.001 ||
  fail "the checkpoint could not be changed"
cp -r "$work/books" "$work/full"
runs 3 resume "$work/books" --until 0.2
grep -q 'the energy budget does not close: residual .* of its sums' "$work/err" || fail "changed books: $(tail -n 1 "$work/err")"
looked_at "changed books" "$work/books"

# No space for the broken state: one line reports both faults, and no partial file is left. A file-size limit simulates the
# full disk.
(
  ulimit -f 20
  exec "$keeler" resume "$work/full" --until 0.2 >"$work/out" 2>"$work/err"
)
code=$?
[ "$code" -eq 3 ] || fail "no room for a broken state: exit $code: $(cat "$work/err")"
one_line "no room for a broken state" "the energy budget does not close"
one_line "no room for a broken state" "and the state could not be saved: cannot write"
compgen -G "$work/full/broken_*" && fail "no room for a broken state: a file was left"
compgen -G "$work/full/*.tmp" && fail "no room for a broken state: a part of a file was left"

# A broken state in generate --clumped: it is saved beside the requested output.
clump=(generate "$work/scene.toml" --clumped -o "$work/wakes.hdf" --set time.step=0.1 --set particles.density=110
  --set 'box.size=[20,20]' --set particles.count=70 --set particles.velocity_dispersion=1000)
runs 3 "${clump[@]}"
sed -i '$!d' "$work/err"
one_line "a broken start" "cross the box"
one_line "a broken start" "the state is in '$work/wakes_broken_000000.hdf'"
[ -e "$work/wakes.hdf" ] && fail "a broken start was written as a start"
runs 0 info "$work/wakes_broken_000000.hdf"
runs 0 render "$work/wakes_broken_000000.hdf" -o "$work/broken.png"
runs 0 analyze "$work/wakes_broken_000000.hdf"
rm "$work/wakes_broken_000000.hdf"
(
  ulimit -f 4
  exec "$keeler" "${clump[@]}" >"$work/out" 2>"$work/err"
)
code=$?
[ "$code" -eq 3 ] || fail "no room for a broken start: exit $code: $(cat "$work/err")"
sed -i '$!d' "$work/err"
one_line "no room for a broken start" "and the state could not be saved: cannot write"
compgen -G "$work/wakes*" && fail "no room for a broken start: a file was left"
report
