#!/bin/bash
# convert.sh KEELER SOURCE_DIR: numpy and VTK read the snapshot's numbers from the CSV and VTP files of keeler convert, a
# table converts back to its state, and a failed conversion leaves no files.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.5/' "$work/scene.toml"
# Debian's Python, for which its packages of h5py and VTK are built.
read_back() { /usr/bin/python3 -B "$source_dir/tests/cli/convert.py" "$@" >"$work/read" 2>&1 || fail "$1: $(cat "$work/read")"; }

runs 0 run "$work/scene.toml" -o "$work/run"
accepts "a run as VTP" convert "$work/run" --to vtp
prints "a run as VTP" "$work/run/vtp/snapshots.pvd"
accepts "a run as CSV" convert "$work/run" --to csv -o "$work/csv"
for number in 000000 000002; do
  prints "a run as CSV" "$work/csv/snap_$number.csv"
  read_back "$work/run/snap_$number.hdf" "$work/csv/snap_$number.csv" "$work/run/vtp/snap_$number.vtp"
done
read_back "$work/run/snap_000001.hdf" "$work/csv/snap_000001.csv" "$work/run/vtp/snap_000001.vtp" "$work/run/vtp/snapshots.pvd"
printf '0 snap_000000.vtp\n0.25 snap_000001.vtp\n0.5 snap_000002.vtp\n' | diff - "$work/read" || fail "the times of the series"

# A checkpoint at the time of a snapshot has its particles.
runs 0 convert "$(newest_checkpoint "$work/run")" --to csv -o "$work/end.csv"
runs 0 convert "$(newest_checkpoint "$work/run")" --to vtp -o "$work/end.vtp"
read_back "$work/run/snap_000002.hdf" "$work/end.csv" "$work/end.vtp"

# Spins.
sed '/^\[gravity\]/,/^solver/d' "$work/scene.toml" >"$work/rough.toml"
echo '[collisions.friction]' >>"$work/rough.toml"
echo 'tangential_restitution = 0.5' >>"$work/rough.toml"
runs 0 run "$work/rough.toml" -o "$work/rough" --set time.end=0.1
for format in csv vtp; do runs 0 convert "$work/rough/snap_000001.hdf" --to $format; done
read_back "$work/rough"/snap_000001.{hdf,csv,vtp}
grep -q sx_rad_s "$work/rough/snap_000001.csv" || fail "no spins"

# A table is a start: the same particles.
runs 0 generate "$work/scene.toml" --from-table "$work/csv/snap_000000.csv" -o "$work/again.hdf"
for dataset in Coordinates Masses Radius ParticleIDs; do
  same_bytes "a table as a start" "/PartType1/$dataset" "$work/run/snap_000000.hdf" "$work/again.hdf"
done
runs 0 convert "$work/again.hdf" --to csv
runs 0 convert "$work/again.hdf" --to vtp
read_back "$work/run/snap_000000.hdf" "$work/again.csv" "$work/again.vtp"

# The formats of other programs: read by numpy, h5py, ASE and yt, and by Keeler, to the same particles and shear offset.
# Only GADGET's places are rounded, when they are shifted by half of the box.
offset() { h5dump -a /RingBox/shear_offset "$1" | grep -F '(0)'; }
snapshot=$work/run/snap_000001.hdf
for format in hdf5 npz xyz gadget; do
  accepts "a run as $format" convert "$work/run" --to $format
  runs 0 convert "$snapshot" --to $format -o "$work/table.$format"
  runs 0 convert "$work/table.$format" --to csv -o "$work/table.csv" --force
  if [ $format != gadget ]; then
    diff <(cut -d, -f2- "$work/csv/snap_000001.csv") <(cut -d, -f2- "$work/table.csv") >"$work/read" || fail "$format: $(head -3 "$work/read")"
  fi
  runs 0 generate "$work/scene.toml" --from-table "$work/table.$format" -o "$work/table.hdf" --force
  [ "$(offset "$work/table.hdf")" = "$(offset "$snapshot")" ] || fail "$format: the shear offset $(offset "$work/table.hdf")"
  h5diff -d 1e-13 "$snapshot" "$work/table.hdf" /PartType1/Coordinates || fail "$format: places"
  h5diff -p 5e-16 "$snapshot" "$work/table.hdf" /PartType1/Velocities || fail "$format: velocities"
done
/usr/bin/python3 -B "$source_dir/tests/cli/convert_others.py" "$snapshot" "$work/table" >"$work/read" 2>&1 || fail "others: $(cat "$work/read")"
for file in npz/snap_000002.npz gadget/snap_000002.hdf5; do [ -e "$work/run/$file" ] || fail "no $file"; done
runs 0 convert "$work/rough/snap_000001.hdf" --to npz -o "$work/rough.npz"
runs 0 convert "$work/rough.npz" --to csv -o "$work/spins.csv"
diff <(cut -d, -f2- "$work/rough/snap_000001.csv") <(cut -d, -f2- "$work/spins.csv") >"$work/read" || fail "spins: $(head -3 "$work/read")"
refuses "another box" "it is of a box of" generate "$work/scene.toml" --set "box.size=[61.0,40.0]" --from-table "$work/table.npz" -o "$work/new.hdf"
refuses "another planet" "its velocities are for Omega" generate "$work/scene.toml" --set planet.preset='"saturn-b-ring"' --from-table "$work/table.npz" -o "$work/new.hdf"

# nothing_new NAME: there are no new files
nothing_new() { compgen -G "$work/new*" && fail "$1 left something"; }
refuses "no format" "--to" convert "$work/run"
refuses "another format" "--to" convert "$work/run" --to xls
refuses "an existing file" "add --force" convert "$work/again.hdf" --to csv
refuses "an existing folder" "add --force" convert "$work/run" --to vtp
runs 0 convert "$work/run" --to vtp --force
refuses_with 4 "no folder to write into" "create it, or name another" convert "$work/run" --to vtp -o "$work/new/a"
nothing_new "no folder to write into"
refuses "neither a snapshot nor a table" "scene.toml:2: " convert "$work/scene.toml" --to csv -o "$work/new.csv"
nothing_new "neither a snapshot nor a table"
refuses "its own source" "" convert "$work/again.csv" --to csv --force
mkdir "$work/empty"
refuses_with 4 "a folder without snapshots" "no snapshot in" convert "$work/empty" --to vtp
[ "$(find "$work/empty" | wc -l)" -eq 1 ] || fail "a folder without snapshots got something"
for format in csv vtp hdf5 npz xyz gadget; do
  (
    ulimit -f 4
    exec "$keeler" convert "$work/again.hdf" --to $format -o "$work/new.$format" >"$work/out" 2>"$work/err"
  )
  code=$?
  [ "$code" -eq 4 ] || fail "a full disk, $format: exit $code: $(cat "$work/err")"
  one_line "a full disk, $format" "cannot write '$work/new.$format"
  nothing_new "a full disk, $format"
done
report
