#!/bin/bash
# outputs.sh KEELER SOURCE_DIR: names and numbers for programs, states as starts, and pictures.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.3/; s/^\[output\]/&\nstress_every = 0.02/' "$work/scene.toml"
number='-?[0-9.]+(e[-+]?[0-9]+)?'

# has KEY PATTERN: the printed JSON, without spaces, has the key with a value of this pattern
has() {
  tr -d ' \n' <"$work/out" | grep -qE "[{,]\"$1\":$2[,}]" || fail "no $1 like $2 in: $(cat "$work/out")"
}

runs 0 run "$work/scene.toml" -o "$work/run" --json
cmp "$work/out" "$work/run/summary.json" || fail "run --json does not print the summary"
for key in collisions_per_particle_orbit slow_contacts_per_particle_orbit wall_s cpu_s largest_overlap; do
  has $key "$number"
done
grep -q '"event":"force_error","step":150,"rms":[0-9]' "$work/run/log.jsonl" ||
  fail "no error of forces at the end: $(cat "$work/run/log.jsonl")"
has force_error "\{\"rms\":$number,\"worst_rms\":$number,\"checks\":[0-9]+,\"particles\":128\}"
awk -F'[:,]' '/"worst_rms"/ { seen = 1; if (!($2 > 0 && $2 < 0.02)) exit 1 } END { exit !seen }' "$work/out" ||
  fail "the error of forces: $(grep -A 5 force_error "$work/out")"
for part in start_s drift_s gravity_s series_s snapshots_s checkpoints_s force_checks_s; do
  has $part "$number"
done
has finished true
has state_hash '"[0-9a-f]{32}"'
has time_orbits '0\.3(0000+[0-9]*)?'
has steps 150
has particle_count 400
runs 0 run "$work/scene.toml" -o "$work/text"
prints "run" "$(state_hash "$work/run")"
prints "run" "error of gravity"
runs 0 run "$work/scene.toml" -o "$work/mean-field" --set gravity.solver=mesh --set particles.count=30 --set time.end=0.02
prints "a mean field" "omitted by the gravity solver: 9"
for name in scene.toml series.csv summary.json log.jsonl snap_000000.hdf snap_000001.hdf snap_000002.hdf \
  checkpoint_000001.h5 checkpoint_000002.h5; do
  [ -s "$work/run/$name" ] || fail "no $name in the folder of a run"
done
[ "$(find "$work/run" -type f | wc -l)" -eq 9 ] || fail "other files than those: $(ls "$work/run")"
accepts "the resolved scene" check "$work/run/scene.toml"

accepts "info of a checkpoint" info "$(newest_checkpoint "$work/run")" --json
has kind '"checkpoint"'
has state_hash "\"$(text state_hash "$work/run/summary.json")\""
has time_orbits '0\.3(0000+[0-9]*)?'
has particle_count 400
accepts "info of a snapshot" info "$work/run/snap_000001.hdf" --json
has kind '"snapshot"'
has time_orbits '0\.25'
has particle_count 400
accepts "info as text" info "$(newest_checkpoint "$work/run")"
prints "info as text" "$(text state_hash "$work/run/summary.json")"


accepts "analyze of a part" analyze "$work/run" --since 0.05 --json --csv "$work/snapshots.csv"
has since_found false
has total_viscosity_m2_s "$number"
has energy_balance "$number"
grep -q '^snapshots,time_orbits,.*,dispersion_x_m_s,.*,total_viscosity_m2_s' "$work/snapshots.csv" ||
  fail "the columns of analyze --csv: $(head -n 1 "$work/snapshots.csv")"
[ "$(wc -l <"$work/snapshots.csv")" -eq 3 ] || fail "analyze --csv has other rows than two snapshots"
refuses "a part without rows" "no snapshot in" analyze "$work/run" --since 9
refuses "a part without snapshots" "no snapshot in" analyze "$work/run" --since 0.02 --until 0.2
refuses "a part of a snapshot" "give the run's folder" analyze "$work/run/snap_000001.hdf" --since 1
refuses_with 4 "a CSV that cannot be written" "none" analyze "$work/run" --csv "$work/none/a.csv"

for path in "$work/run" "$work/run/snap_000002.hdf"; do
  accepts "analyze" analyze "$path" --json
  for key in dispersion_m_s dispersion_r_omega; do
    has $key "\[$number,$number,$number\]"
  done
  for key in toomre_q largest_overlap surface_density_kg_m2 critical_wavelength_m; do
    has $key "$number"
  done
  for key in wake_pitch_degrees wake_spacing_m; do
    has $key "($number|null)"
  done
  has optical_depth '0\.5026[0-9]*' # 400 pi / 50^2
done
accepts "profiles" analyze "$work/run" --profile "$work/profile.csv" --bins 20
[ "$(wc -l <"$work/profile.csv")" -eq $((1 + 3 * 20)) ] || fail "other profiles than three of 20 bins"
awk -F, 'NR > 1 { tau += $5 / 60 } END { exit !(tau > 0.5026 && tau < 0.5027) }' "$work/profile.csv" ||
  fail "the optical depth of the profiles: $(head -3 "$work/profile.csv")"
accepts "analyze as text" analyze "$work/run"
prints "analyze as text" "optical depth                      0.5027"

# Texts for users: unknown numbers are reported, counts have plurals, and 1000 is not printed as 1e+03.
runs 0 generate "$work/scene.toml" -o "$work/one.hdf" --set particles.count=1
prints "generate" "1 particle in 50 m x 50 m"
accepts "analyze one particle" analyze "$work/one.hdf"
prints "analyze one particle" "wakes: pitch                       not known because"
prints "analyze one particle" "wakes: radial spacing              not known because"
runs 0 run "$work/scene.toml" -o "$work/crowd" --threads 1 --set time.end=0.1 --set particles.density=3e4
prints "run" "particles                          400"
prints "run" "threads                            1"
grep -qE '^collisions per particle and orbit +[0-9]{4,}$' "$work/out" || fail "more than 1000 collisions: $(cat "$work/out")"
grep -qE '[0-9]e\+' "$work/out" && fail "a summary with exponents: $(cat "$work/out")"
grep -q "^keeler: note: 400 particles are few" "$work/err" || fail "a run does not say that its patch is small"

# A state, and a run from it; a seed gives the same state for any number of threads.
for threads in 1 2; do
  accepts "generate" generate "$work/scene.toml" -o "$work/state-$threads.hdf" --threads $threads
  accepts "analyze" analyze "$work/state-$threads.hdf" --json
  grep -v '"file"' "$work/out" >"$work/state-$threads.json"
done
cmp "$work/state-1.json" "$work/state-2.json" || fail "the state depends on the threads"
mkdir "$work/a folder"
cp "$work/state-1.hdf" "$work/a folder/2024"
runs 0 run "$work/scene.toml" --from "$work/a folder/2024" -o "$work/from" --set time.end=0.01 --json
has particle_count 400
grep -qF -- "keeler: note: box of the scene is ignored: --from $work/a folder/2024 replaces it" "$work/err" ||
  fail "--from: $(cat "$work/err")"
(cd "$work/a folder" && "$keeler" run ../scene.toml --from 2024 -o here --set time.end=0.01 >/dev/null 2>&1) ||
  fail "--from with a name that looks like a number"
[ "$(state_hash "$work/a folder/here")" = "$(state_hash "$work/from")" ] || fail "--from: another state"

is_png() {
  [ "$(od -An -tx1 -N 8 "$1" | tr -d ' ')" = 89504e470d0a1a0a ] || fail "$1 is not a PNG"
}
accepts "render a folder" render "$work/run"
prints "render a folder" "$work/run/picture.png"
is_png "$work/run/picture.png"
accepts "render a file" render "$work/run/snap_000000.hdf"
is_png "$work/run/snap_000000.png"
accepts "render to a name" render "$work/run/snap_000000.hdf" -o "$work/mine.png"
is_png "$work/mine.png"
for field in size speed cluster density; do
  accepts "render $field" render "$work/run" -o "$work/$field.png" --colour $field --width 600 --theme light
  is_png "$work/$field.png"
  [ "$(od -An -tu1 -j 16 -N 4 "$work/$field.png" | tr -s ' ')" = " 0 0 2 88" ] || fail "$field: not 600 pixels wide"
done

# Movies have one frame per snapshot.
accepts "a movie" render "$work/run" --movie --width 400
prints "a movie" "$work/run/movie.mp4"
frames=$(ffprobe -v error -count_frames -show_entries stream=codec_name,width,nb_read_frames -of csv=p=0 "$work/run/movie.mp4")
[ "$frames" = "h264,400,3" ] || fail "a movie of $frames"
compgen -G "$work/run/*.tmp" && fail "a part of a movie was left"

# A standard output that cannot be written is a failure.
if [ -e /dev/full ]; then
  for arguments in "check $work/scene.toml" "info $work/run/snap_000000.hdf" "analyze $work/run --json"; do
    code=0
    # shellcheck disable=SC2086 # several words
    "$keeler" $arguments >/dev/full 2>"$work/err" || code=$?
    [ "$code" -eq 4 ] || fail "$arguments into a full device: exit $code"
    one_line "$arguments into a full device" "cannot write to standard output"
  done
fi

report
