#!/bin/bash
# errors.sh KEELER SOURCE_DIR: an impossible request ends with one line and its exit code, and leaves no files.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
cp "$work/scene.toml" "$work/good.toml"
none=$work/none

nothing_left() {
  [ -e "$none" ] && fail "$1: left $none behind"
  rm -rf "$none"
}

# bad NAME WORDS SED-COMMAND: run and generate refuse the good scene, changed by the command
bad() {
  sed "$3" "$work/good.toml" >"$work/scene.toml"
  cmp -s "$work/scene.toml" "$work/good.toml" && fail "$1: the change does nothing"
  refuses "$1" "$2" run "$work/scene.toml" -o "$none"
  nothing_left "$1"
  refuses "$1" "$2" generate "$work/scene.toml" -o "$none"
  nothing_left "$1"
}

bad "unknown key" 'did you mean "density"?' 's/^density/densty/'
bad "wrong type" "particles.count is a string" 's/count = 400/count = "many"/'
bad "negative radius" "particles.sizes.radius is -1.0" 's/radius = 1.0/radius = -1.0/'
bad "small box" "is smaller than a particle" 's/size = .*/size = [1.5, 100]/'
bad "too dense" "too dense" 's/count = 400/count = 4000/'
bad "missing section" "[box] is missing" '/^\[box\]/,/^size/d'
bad "not TOML" "not TOML" 's/\[box\]/[box/'
cp "$work/good.toml" "$work/scene.toml"

for path in absent.toml .; do
  refuses "unreadable $path" "cannot be read" run "$work/$path" -o "$none"
  nothing_left "unreadable $path"
done
if [ "$(id -u)" -ne 0 ]; then # root may read everything
  cp "$work/good.toml" "$work/locked.toml"
  chmod 000 "$work/locked.toml"
  refuses "locked scene" "Permission denied" run "$work/locked.toml" -o "$none"
fi
refuses "binary scene" "not TOML" run "$keeler" -o "$none"
refuses "bad override" "particles.count" run "$work/scene.toml" -o "$none" --set particles.count=-1
refuses "no output" "--output" run "$work/scene.toml"
refuses "no such command" "foo" foo
refuses "no threads" "--threads" run "$work/scene.toml" -o "$none" --threads 0
refuses "no wall time" "--wall-time" run "$work/scene.toml" -o "$none" --wall-time -1
nothing_left "bad options"

# Whole numbers may be written as in scenes; faults that CLI11 finds are reported in the program's words.
while read -r option what words; do
  read -ra command <<<"$words"
  for value in 1.5 x 99999999999999999999 1e400 0x; do
    refuses "$words $option $value" "$option: '$value' is not a number of $what from " "${command[@]}" "$option" "$value"
  done
done <<'END'
--count particles bench drift
--count particles bench gravity
--count particles bench step
--count particles study finders
--repeats repeats bench drift
--repeats repeats bench gravity
--kick-every steps bench step
--seeds seeds study mesh
--seeds seeds study step
--jobs runs study step
--jobs runs sweep grid.toml
--threads threads sweep grid.toml
--threads threads bench gravity
--threads threads run scene.toml
--modes modes analyze run
--bins bins analyze run
--rays rays analyze run
--width pixels render run
--snapshots snapshots report run
END
refuses "half a thread" "from 1 to 1024; give a whole number" run "$work/scene.toml" -o "$none" --threads 1.5
runs 0 bench drift --count 2e2 --repeats 1e0 --threads 1.0
refuses "an orbit in words" "--since: 'x' is not a number; \"keeler analyze --help\"" analyze run --since x
refuses "a word too many" "'keeler check' takes no further argument 'b'" check "$work/scene.toml" b
refuses "two folders" "--output is given 2 times, and takes one value" run "$work/scene.toml" -o "$none" -o "$none"
refuses "an option without its value" "--wall-time has no value" run "$work/scene.toml" -o "$none" --wall-time
nothing_left "bad values of options"

# No result overwrites its source.
cp "$work/scene.toml" "$work/kept.toml"
printf 'x,y,z,r\n0,0,0,1\n' >"$work/table.csv"
refuses "a scene's own place" "is the source of the result" generate "$work/kept.toml" -o "$work/./kept.toml" --force
refuses "a table's own place" "is the source of the result" generate "$work/kept.toml" --from-table "$work/table.csv" \
  -o "$work/table.csv" --force
cmp -s "$work/scene.toml" "$work/kept.toml" || fail "a scene was replaced by its state"

runs 0 run "$work/scene.toml" -o "$work/taken" --set time.end=0.01
cp -r "$work/taken" "$work/before"
refuses "occupied folder" "--force" run "$work/scene.toml" -o "$work/taken"
diff -r "$work/taken" "$work/before" >/dev/null || fail "a refused run changed the folder"
refuses "an end behind" "later end" resume "$work/taken" --until 0.005
diff -r "$work/taken" "$work/before" >/dev/null || fail "a refused resume changed the folder"
echo mine >"$work/taken/notes.txt"
runs 0 run "$work/scene.toml" -o "$work/taken" --set time.end=0.004 --force
[ "$(cat "$work/taken/notes.txt")" = mine ] || fail "--force removed a file that is not the run's"
[ "$(text steps "$work/taken/summary.json")" -eq 2 ] || fail "--force did not run"

runs 0 generate "$work/scene.toml" -o "$work/start.hdf"
refuses "a start from another orbit" "another orbit" run "$work/scene.toml" -o "$none" --from "$work/start.hdf" \
  --set planet.preset=saturn-c-ring
refuses "a state over a folder" "is a folder" generate "$work/scene.toml" -o "$work/taken" --force
nothing_left "bad starts"

"$keeler" run "$work/scene.toml" -o "$work/busy" --set time.end=1000 >"$work/busy.out" 2>&1 &
busy=$!
for ((k = 0; k < 100; k++)); do
  [ -e "$work/busy/series.csv" ] && break
  sleep 0.05
done
refuses "a folder with a run going on" "another process" run "$work/scene.toml" -o "$work/busy" --force
refuses "resuming a run going on" "another process" resume "$work/busy"
kill -9 $busy
wait $busy 2>/dev/null

touch "$work/file"
refuses "a file as folder" "is a file" run "$work/scene.toml" -o "$work/file"
refuses_with 4 "a file as parent" "is not a writable folder" run "$work/scene.toml" -o "$work/file/run"
refuses_with 4 "a state below a file" "file/state.hdf" generate "$work/scene.toml" -o "$work/file/state.hdf"
refuses "a state that exists" "--force" generate "$work/scene.toml" -o "$work/file"
[ -s "$work/file" ] && fail "a refused state was written"
if [ "$(id -u)" -ne 0 ]; then
  mkdir -m 555 "$work/locked"
  refuses_with 4 "a locked parent" "Permission denied" run "$work/scene.toml" -o "$work/locked/run"
fi

for command in info analyze render; do
  refuses_with 4 "$command, absent" "absent.hdf" $command "$work/absent.hdf"
  refuses_with 4 "$command, not HDF5" "good.toml" $command "$work/good.toml"
  refuses "$command of nothing" "required" $command
done
# NaN passes no range check, and no time or length may be infinite.
for number in nan -nan inf; do
  refuses "a limit of $number" "--most-orbits" generate "$work/scene.toml" --clumped -o "$none" --most-orbits $number
  refuses "an optical depth of $number" "--optical-depth" bench drift --count 100 --optical-depth $number
  refuses "a step of $number" "--step" bench drift --count 100 --step $number
  refuses "a wall time of $number" "--wall-time" run "$work/scene.toml" -o "$none" --wall-time $number
  refuses "an end of $number" "--until" resume "$work/taken" --until $number
  refuses "a gap of $number" "--cluster-gap" analyze "$work/taken" --cluster-gap $number
  refuses "a footprint of $number" "--footprint" analyze "$work/taken" --elevation 20 --footprint $number
  refuses "an azimuth of $number" "--azimuth" analyze "$work/taken" --elevation 20 --azimuth $number
done
refuses "a part until nan" "is not a number" analyze "$work/taken" --until nan
refuses "a part since nan" "is not a number" analyze "$work/taken" --since nan

refuses "an elevation of 0" "'0' is not an elevation from 0.1 to 90" analyze "$work/taken" --elevation 0
refuses "an elevation in words" "'steep' is not an elevation" analyze "$work/taken" --elevation 10,steep
refuses "an azimuth alone" "--elevation" analyze "$work/taken" --azimuth 10
refuses "no rays" "'0' is not a number of rays" analyze "$work/taken" --elevation 10 --rays 0
refuses "a footprint of 0" "--footprint" analyze "$work/taken" --elevation 10 --footprint 0
refuses_with 4 "a profile below a file" "file/profile.csv" analyze "$work/taken" --profile "$work/file/profile.csv"
refuses "a profile over a folder" "is a folder" analyze "$work/taken" --profile "$work/taken"
refuses "no bins" "'0' is not a number of bins" analyze "$work/taken" --profile "$work/profile.csv" --bins 0
refuses "bins without a profile" "--profile" analyze "$work/taken" --bins 10
[ -e "$work/profile.csv" ] && fail "a refused profile was written"
mkdir "$work/empty"
for command in analyze render; do
  refuses_with 4 "$command, no snapshot" "no snapshot" $command "$work/empty"
  refuses_with 4 "$command of a checkpoint" "checkpoint_" $command "$(newest_checkpoint "$work/taken")"
done
refuses "a field that is not there" "'mass' is not a field of a picture; choose one of height, size, speed, spin" \
  render "$work/taken" -o "$work/none.png" --colour mass
refuses "spins of smooth particles" "choose another field" render "$work/taken" -o "$work/none.png" --colour spin
refuses "a theme that is not there" "--theme" render "$work/taken" -o "$work/none.png" --theme green
refuses "a picture of no width" "'0' is not a number of pixels" render "$work/taken" -o "$work/none.png" --width 0
refuses "a movie of a file" "not a folder" render "$work/taken/snap_000000.hdf" --movie -o "$work/none.mp4"
refuses "a movie of another kind" "movies are .mp4 files; give it that ending" render "$work/taken" --movie -o "$work/none.png"
mkdir "$work/nothing"
refuses_with 4 "a movie of nothing" "no snapshot" render "$work/nothing" --movie -o "$work/none.mp4"
refuses_with 4 "a movie in no folder" "absent" render "$work/taken" --movie -o "$work/absent/none.mp4"
[ -e "$work/none.png" ] && fail "a refused picture was written"
if [ "$(id -u)" -ne 0 ]; then
  mkdir -m 555 "$work/sealed"
  refuses_with 4 "a movie in a locked folder" "no folder that can be written" render "$work/taken" --movie -o "$work/sealed/m.mp4"
fi
PATH=$work "$keeler" render "$work/taken" --movie -o "$work/none.mp4" >"$work/out" 2>"$work/err"
[ $? -eq 2 ] || fail "an MP4 without ffmpeg"
one_line "an MP4 without ffmpeg" "install the package ffmpeg"
(
  ulimit -f 4 # stands for a disk that fills up
  exec "$keeler" render "$work/taken" --movie -o "$work/none.mp4" >"$work/out" 2>"$work/err"
)
[ $? -eq 4 ] || fail "a disk that fills up under a movie"
one_line "a disk that fills up under a movie" "File too large"
compgen -G "$work/none.*" && fail "a part of a movie was left"
refuses_with 4 "a picture below a file" "file/picture.png" render "$work/taken" -o "$work/file/picture.png"
for start in absent.hdf good.toml taken/scene.toml; do
  runs 4 run "$work/scene.toml" --from "$work/$start" -o "$none"
  nothing_left "from $start"
done

report
