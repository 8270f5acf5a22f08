#!/bin/bash
# formats.sh KEELER SOURCE_DIR: files of every earlier format (tests/fixtures, made by scripts/fixtures) can be read with
# unchanged meaning and continued from; and `keeler info --verify` finds damaged files.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"

for fixture in "$source_dir"/tests/fixtures/*/; do
  name=$(basename "$fixture")
  rm -rf "$work/run"
  cp -r "$fixture/run" "$work/run"
  chmod -R u+w "$work/run"
  accepts "$name" info --verify "$work/run"
  prints "$name" "checkpoint  checkpoint_000001.h5"
  [ "$(state_hash "$work/run")" = "$(cat "$fixture/state_hash")" ] || fail "$name: another state_hash than when it was written"
  accepts "$name, contacts" info "$work/run/collisions_000000.h5" --json
  rows=$(text contact_count "$work/out")
  [ "$rows" -ge 5 ] || fail "$name: contacts: $rows"
  accepts "$name, snapshot" info "$work/run/snap_000001.hdf" --json
  prints "$name, snapshot" '"particle_count": 26'
  accepts "$name, analyzed" analyze "$work/run/snap_000001.hdf"
  accepts "$name, as a table" convert "$work/run/snap_000001.hdf" --to csv -o "$work/table.csv" --force
  [ "$(sha256sum <"$work/table.csv")" = "$(sha256sum <"$fixture/snap_000001.csv")" ] || fail "$name: other numbers in the snapshot"
  runs 0 run "$work/run/scene.toml" --from "$work/run/snap_000001.hdf" -o "$work/from" --force --set time.end=0.02
  runs 0 resume "$work/run" --until 0.12
  grep -q 'cannot\|missing' "$work/err" && fail "$name, resumed: $(cat "$work/err")"
  [ "$(tail -n 1 "$work/run/series.csv" | cut -d , -f 1)" -eq 30 ] || fail "$name: rows after a restart"
  accepts "$name, resumed" info --verify "$work/run"
  cmp -s <(head -n 1 "$fixture/run/series.csv") <(head -n 1 "$work/run/series.csv") || fail "$name: other columns in the series"
done

# The verified files of a run.
run=$work/run
each() { # NAME LINE...: the lines on the files, in this order
  local said
  said=$(sed -E 's/ +/ /g' "$work/out")
  [ "$said" = "$(printf '%s\n' "${@:2}")" ] || fail "$1: $said"
}
runs 0 info --verify "$run"
each "a whole run" "checkpoint checkpoint_000001.h5 whole" "checkpoint checkpoint_000002.h5 whole" \
  "contacts collisions_000000.h5 whole" "series impact_speeds.csv whole" "log log.jsonl whole" "series moonlets.csv whole" \
  "scene scene.toml whole" "series series.csv whole" "snapshot snap_000000.hdf whole" "snapshot snap_000001.hdf whole" \
  "snapshot snap_000002.hdf whole" "summary summary.json whole"

# damaged NAME WORDS FILE COMMAND: the command damages only this file, which is reported alone and among the others
damaged() {
  rm -rf "$work/hurt"
  cp -r "$run" "$work/hurt"
  (cd "$work/hurt" && eval "$4") || fail "$1: cannot be done"
  runs 4 info --verify "$work/hurt"
  one_line "$1" "$2"
  one_line "$1" "1 of 12 files are damaged, the first: "
  [ "$(grep -c ' damaged: ' "$work/out")" -eq 1 ] || fail "$1: $(cat "$work/out")"
  grep " $3 .*damaged: " "$work/out" >"$work/line"
  grep -qF "$2" "$work/line" || fail "$1: no '$2' in $(cat "$work/out")"
  runs 4 info --verify "$work/hurt" --json
  prints "$1, JSON" '"damaged": 1,'
}
flip='/usr/bin/python3 -c "import sys; b = bytearray(open(sys.argv[1], \"rb\").read()); b[len(b) // 2] ^= 1; open(sys.argv[1], \"wb\").write(b)"'
for file in checkpoint_000001.h5 snap_000001.hdf collisions_000000.h5; do
  damaged "a bit of $file" "does not match its checksum" $file "$flip $file"
  runs 4 info --verify "$work/hurt/$file"
  one_line "$file alone" "does not match its checksum"
done
damaged "a torn checkpoint" "its end is missing" checkpoint_000002.h5 "truncate -s -9 checkpoint_000002.h5"
damaged "a row of the series" "values in" series.csv "sed -i '3s/,/;/' series.csv"
damaged "a step that is no number" "line 3 of" series.csv "sed -i '3s/^[0-9]*,/nan,/' series.csv"
damaged "a time that is no number" "line 3 of" series.csv "sed -Ei '3s/^([0-9]*),[^,]*,/\1,nan,/' series.csv"
damaged "exchanged rows" "line 3 of" series.csv "sed -i '2{h;d};3{G}' series.csv"
damaged "the scene" "not TOML" scene.toml "echo '[' >>scene.toml"
damaged "the summary" "not the summary" summary.json "echo '{' >summary.json"
damaged "the summary of another run" "not that of the newest checkpoint" summary.json "sed -i '/state_hash/s/[0-9a-f]\"/x\"/' summary.json"
damaged "the log" "line 1 of" log.jsonl "sed -i '1s/{/[/' log.jsonl"
rm -rf "$work/hurt"
cp -r "$run" "$work/hurt"
sed -i 's/^tangential_restitution = .*/tangential_restitution = 0.9/' "$work/hurt/scene.toml"
runs 4 info --verify "$work/hurt"
prints "a scene of another run" "has other physics than scene.toml"

# Line ends of Windows are accepted.
rm -rf "$work/hurt"
cp -r "$run" "$work/hurt"
sed -i 's/$/\r/' "$work"/hurt/{series.csv,moonlets.csv,impact_speeds.csv,log.jsonl,scene.toml}
for command in "info --verify" info analyze "render --series" "resume --until 0.14"; do
  # shellcheck disable=SC2086 # a command and its options
  runs 0 $command "$work/hurt"
  grep -q 'edited\|missing' "$work/err" && fail "lines of Windows, $command: $(cat "$work/err")"
done
grep -q $'\r' "$work"/hurt/*.csv && fail "lines of Windows beside others"

# A file changed by another program has no seal; its numbers are checked.
edited() { # NAME PYTHON: the open file is `f`
  cp "$run/snap_000002.hdf" "$work/edited.hdf"
  /usr/bin/python3 -c "import h5py
with h5py.File('$work/edited.hdf', 'r+') as f:
  $2"
}
edited "a note" "f.attrs['note'] = 'mine'"
accepts "a note" info --verify "$work/edited.hdf"
prints "a note" "whole as far as can be told without a seal"
edited "an overlap" "c = f['PartType1/Coordinates']; c[3] = c[4] + 1e-3"
refused() { # NAME WORDS
  runs 4 info --verify "$work/edited.hdf"
  one_line "$1" "$2"
}
refused "an overlap" "overlap by"
edited "a number that is none" "c = f['PartType1/Velocities']; c[3] = float('nan')"
refused "a number that is none" "not finite"
edited "an id twice" "c = f['PartType1/ParticleIDs']; c[3] = c[4]"
refused "an id twice" "ParticleIDs do not increase"
edited "another planet" "f['RingBox'].attrs['Omega'] = 2e-4"
refused "another planet" "other frequencies than the scene"
edited "an older version" "f['Code'].attrs['format_version'] = 0"
refused "an older version" "use the older Keeler"
edited "a newer version" "f['Code'].attrs['format_version'] = 99"
refused "a newer version" "use the newer Keeler"

# docs/formats.md names for every entry the setting that it depends on.
cat >"$work/minimal.toml" <<'END'
planet.preset = "saturn-a-ring"
box.size = [18, 18]
particles = { count = 20, density = 600.0, sizes = { law = "equal", radius = 1.0 } }
time.end = 0.02
END
cp "$work/minimal.toml" "$work/full.toml"
cat >>"$work/full.toml" <<'END'
[[moonlet]]
radius = 2.0
density = 900.0
[collisions]
finder = "newton-relative"
[collisions.friction]
tangential_restitution = 0.5
[gravity]
solver = "tree"
resting_contacts = "carried"
[constant_acceleration]
radial = 1e-9
END
runs 0 run "$work/minimal.toml" -o "$work/minimal"
runs 0 run "$work/full.toml" --set time.step=auto --set output.collisions.fraction=1.0 -o "$work/full"
/usr/bin/python3 "$(dirname "$0")/formats_page.py" "$source_dir" "$work/minimal" "$work/full" >"$work/out" ||
  fail "docs/formats.md: $(cat "$work/out")"

mkdir "$work/empty"
runs 4 info --verify "$work/empty"
one_line "no run" "holds no run"
mkdir -p "$work/sweep/runs"
cp -r "$run" "$work/sweep/runs/a"
accepts "a sweep" info --verify "$work/sweep"

report
