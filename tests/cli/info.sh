#!/bin/bash
# info.sh KEELER SOURCE_DIR: keeler info describes the folder of a run, a sweep or a study.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
cp "$work/scene.toml" "$work/small.toml"
sed -i 's/^end .*/end = 0.3/' "$work/scene.toml"
echo '[output.collisions]' >>"$work/scene.toml"

# number EXPRESSION VALUE: the Python expression has this value in the printed JSON
number() {
  local found
  found=$(/usr/bin/python3 -c "import json, sys; info = json.load(sys.stdin); print(($1))" <"$work/out")
  [ "$found" = "$2" ] || fail "$1 is $found, not $2, in $(cat "$work/out")"
}

runs 0 run "$work/scene.toml" -o "$work/run" --threads 1
accepts "a run" info "$work/run" --json
number 'info["kind"], info["state"], info["title"]' "('run', 'finished', 'Small patch')"
number 'info["particle_count"], info["threads"]' "(400, 1)"
number 'round(info["time_orbits"], 9), info["end_orbits"], info["remaining_s"]' "(0.3, 0.3, None)"
number '[file["time_orbits"] for file in info["snapshots"]][:2]' "[0.0, 0.25]"
number '[(file["file"], file["steps"]) for file in info["checkpoints"]]' \
  "[('checkpoint_000001.h5', 100), ('checkpoint_000002.h5', 150)]"
number 'info["series"]["rows"]' "$(($(wc -l <"$work/run/series.csv") - 1))"
number 'info["bytes"]' "$(find "$work/run" -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum }')"
number 'info["wall_s"] < 60' True
number '"keeler " + info["version"]' "$("$keeler" --version)"
"$keeler" info "$work/run/snap_000000.hdf" >"$work/said"
number '"Code/commit" + " " * 18 + info["commit"]' "$(grep Code/commit "$work/said")"
contacts=$(/usr/bin/python3 -c 'import json, sys; print(sum(f["contact_count"] for f in json.load(sys.stdin)["contacts"]))' <"$work/out")
[ "$contacts" -gt 100 ] || fail "contacts: $contacts"
accepts "a run in words" info "$work/run"
prints "a run in words" "state       finished"
prints "a run in words" "orbits      0.3 of 0.3"
prints "a run in words" "snap_000001.hdf         orbit 0.25"
prints "a run in words" "checkpoint_000002.h5    step 150"

# A damaged file is reported.
printf 'x' | dd of="$work/run/snap_000001.hdf" bs=1 seek=4000 conv=notrunc 2>/dev/null
accepts "a damaged file" info "$work/run" --json
number '[file["damaged"] for file in info["snapshots"]]' "[False, True, False]"
accepts "a damaged file in words" info "$work/run"
prints "a damaged file in words" "snap_000001.hdf         damaged"

# A group of another tool beside the arrays, and an invalid scene.
/usr/bin/python3 - "$work/run/snap_000000.hdf" "$work/grouped.hdf" <<'END'
import shutil, sys
import h5py
shutil.copy(sys.argv[1], sys.argv[2])
with h5py.File(sys.argv[2], "a") as file:
    file["PartType1"].create_group("notes")["self"] = file["PartType1"]
END
accepts "a group among the arrays" info "$work/grouped.hdf"
accepts "a group among the arrays, as a table" convert "$work/grouped.hdf" --to csv -o "$work/grouped.csv"
cp -r "$work/run" "$work/broken"
echo 'end = = 3' >>"$work/broken/scene.toml"
refuses_with 4 "a broken scene" "scene.toml' is damaged: it is no longer a scene of Keeler" info "$work/broken"

# Running, killed and stopped runs.
cp "$work/small.toml" "$work/scene.toml"
"$keeler" run "$work/scene.toml" --set time.end=1e5 --set output.snapshot_every=0 \
  -o "$work/works" >/dev/null 2>&1 &
process=$!
until [ "$(newest_checkpoint "$work/works" 2>/dev/null)" ] || ! kill -0 $process; do sleep 0.05; done
until { accepts "at work" info "$work/works" --json; grep -q '"remaining_s": [0-9]' "$work/out"; } || ! kill -0 $process; do sleep 0.1; done
number 'info["state"], info["remaining_s"] > 0, info["wall_s"] >= 0' "('running', True, True)"
kill -KILL "$process"
wait "$process" 2>/dev/null
accepts "killed" info "$work/works"
prints "killed" "state       not running; \"keeler resume $work/works\" continues"
prints "killed" "wall time   not known"
rm "$work"/works/checkpoint_*.h5
accepts "killed before a checkpoint" info "$work/works"
prints "killed before a checkpoint" 'state       not running; no checkpoint: "keeler run --force" starts it again'
interrupted TERM 75 "$work/stopped"
accepts "stopped" info "$work/stopped"
prints "stopped" "state       stopped; \"keeler resume $work/stopped\" continues"

printf 'scene = "scene.toml"\nseeds = [1, 2]\n[set]\n"time.end" = 0.004\n' >"$work/grid.toml"
runs 0 sweep "$work/grid.toml" -o "$work/sweep"
accepts "a sweep" info "$work/sweep" --json
number 'info["kind"], info["runs"]["finished"], info["runs"]["failed"]' "('sweep', 2, 0)"
number '"sweep.csv" in info["files"] and "grid.toml" in info["files"]' True
accepts "a sweep in words" info "$work/sweep"
prints "a sweep in words" "runs        2 finished"
mkdir "$work/study"
echo '{"study": "gravity"}' >"$work/study/study.json"
accepts "a study" info "$work/study"
prints "a study" "kind        study, gravity"

mkdir "$work/empty"
refuses_with 4 "another folder" "holds no run, sweep or study" info "$work/empty"
refuses_with 4 "no folder" "cannot read" info "$work/nowhere"
report
