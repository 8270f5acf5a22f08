#!/bin/bash
# everything.sh KEELER SOURCE_DIR MPIEXEC: what a run may ask for beside the solver `fft` has the bits of one process on
# ranks too: the tree, direct sums, radial waves, contacts at rest, inexact finders, checks of forces, --check, and the
# state beside an error.
# shellcheck source=tests/ranks/helpers.sh
source "$(dirname "$0")/helpers.sh"

output='[output]
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.1'
small='[box]
size = [110, 60]
[particles]
count = 1100
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 0.1'
scene tree "$small
[gravity]
solver = \"tree\"
resting_contacts = \"bounced\"
$output"
scene direct "$small
[gravity]
solver = \"direct\"
resting_contacts = \"bounced\"
$output"
scene axisymmetric "$small
[gravity]
solver = \"axisymmetric\"
shortest_wavelength = 12.0
$output"
# a pile that the tide does not disrupt, in rolling contact, which crosses the edge of the box; kicks after every second
# drift
scene pile '[box]
size = [60, 40]
[particles]
count = 300
density = 1500.0
sizes = { law = "equal", radius = 1.0 }
[[particles.aggregate]]
count = 200
filling_factor = 0.5
position = [28, 3, 0]
[collisions.friction]
tangential_restitution = 0.5
[gravity]
solver = "fft"
kick_every = 2
resting_contacts = "carried"
[time]
step = 2e-3
end = 0.4
[output]
collisions = { at_rest = "logged" }
series_every = 0.04
snapshot_every = 0.2
checkpoint_every = 0.2'

# error_of FOLDER: the error of forces that the last check found
error_of() {
  /usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["force_error"]["rms"])' "$1/summary.json"
}
for name in tree direct axisymmetric pile; do
  on_all_ranks "$name"
  [ "$name" = axisymmetric ] && continue
  for other in 2-1 2-2 3-1 4-2 8-1; do
    [ "$(error_of "$work/$name-$other")" = "$(error_of "$work/$name-1")" ] || fail "$name, $other: another error of forces"
  done
done
[ "$(text resting_contacts "$work/pile-1/summary.json")" -gt 100 ] || fail "pile: few contacts at rest"

# The pile is stopped on 3 ranks, resumed on 4, then on one.
on_ranks 3 1 0 run "$work/pile.toml" -o "$work/cut" --set time.end=0.2
on_ranks 4 1 0 resume "$work/cut" --until 0.3
runs 0 resume "$work/cut" --until 0.4
[ "$(state_hash "$work/cut")" = "$(state_hash "$work/pile-1")" ] || fail "3, 4, 1 ranks: state_hash differs"

# Inexact finders
scene finders "$small
$output"
for finder in original newton-cubic-cached linear-full; do
  cp "$work/finders.toml" "$work/$finder.toml"
  on_all_ranks "$finder" --set collisions.finder="$finder"
done

# --check reads, so it changes no bit.
on_ranks 3 1 0 run "$work/tree.toml" -o "$work/tree-checked" --check --set time.end=0.04
on_ranks 3 1 0 resume "$work/tree-checked" --check --until 0.1
[ "$(state_hash "$work/tree-checked")" = "$(state_hash "$work/tree-1")" ] || fail "tree, checked: state_hash differs"
same_series "tree, checked" "$work/tree-1" "$work/tree-checked"
on_ranks 3 2 0 run "$work/pile.toml" -o "$work/pile-checked" --check
same "pile, checked" "$work/pile-1" "$work/pile-checked"

# broken NAME WORDS FOLDER OTHER: both runs ended with the same broken state, and ranks told of theirs in one line
broken() {
  local name=$1 words=$2 file
  file=$(cd "$3" && echo broken_*)
  [ "$(grep -c '^keeler: .*broken' "$work/err")" -eq 1 ] || fail "$name: not one line: $(cat "$work/all")"
  grep -qF -- "the state is in '$4/$file'" "$work/err" || fail "$name: the state is not told: $(cat "$work/err")"
  grep -qE -- "$words" "$work/err" || fail "$name: $(cat "$work/err")"
  same_bytes "$name" /PartType1 "$3/$file" "$4/$file"
  grep -q '"event":"broken"' "$4/log.jsonl" || fail "$name: the log does not tell"
}
# A finder that loses contacts in long steps
small_scene
lossy=(--check --set collisions.finder=newton-cubic --set time.step=0.05 --set output.checkpoint_every=0
  --set gravity.resting_contacts=bounced)
runs 3 run "$work/scene.toml" "${lossy[@]}" -o "$work/lossy-1"
on_ranks 3 1 3 run "$work/scene.toml" "${lossy[@]}" -o "$work/lossy-3"
broken "a lossy finder" 'no overlap: particles [0-9]+ and [0-9]+ overlap' "$work/lossy-1" "$work/lossy-3"
# A checkpoint with other energy sums
cp -r "$work/tree-1" "$work/books-1"
/usr/bin/python3 -B "$source_dir/tests/cli/change_checkpoint.py" "$(newest_checkpoint "$work/books-1")" \
  collision_energy_lost 1.001 || fail "the checkpoint could not be changed"
cp -r "$work/books-1" "$work/books-4"
runs 3 resume "$work/books-1" --until 0.2
on_ranks 4 1 3 resume "$work/books-4" --until 0.2
broken "changed books" 'the energy budget does not close' "$work/books-1" "$work/books-4"
report
