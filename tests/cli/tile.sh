#!/bin/bash
# tile.sh KEELER SOURCE_DIR: a snapshot repeated into a larger patch: one copy is the same state, many copies give a state
# that runs, and an unsuitable snapshot is refused.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.3
small=$(find "$work/run" -name 'snap_*.hdf' | sort | tail -n 1)

accepts "one copy" tile "$small" 1 1 -o "$work/same.hdf"
same_bytes "one copy" /PartType1 "$small" "$work/same.hdf"

accepts "3 x 2 copies" tile "$small" 3 2 -o "$work/tiled.hdf"
prints "3 x 2 copies" "2400 particles in 150 m x 100 m, 3 x 2 copies of $small: $work/tiled.hdf"
accepts "info" info "$work/tiled.hdf" --json
prints "the scene in the file starts from it" "from = \\\"$work/tiled.hdf\\\""
prints "the command in the file" "tile $small 3 2 -o $work/tiled.hdf"
accepts "1 thread" tile "$small" 3 2 -o "$work/one.hdf" --threads 1
same_bytes "1 thread" /PartType1 "$work/tiled.hdf" "$work/one.hdf"
accepts "analyze" analyze "$work/tiled.hdf" --json
large_depth=$(text optical_depth "$work/out")
accepts "analyze" analyze "$small" --json
{ [ -n "$large_depth" ] && [ "${large_depth:0:12}" = "$(text optical_depth "$work/out" | cut -c 1-12)" ]; } ||
  fail "optical depth $large_depth after tiling, $(text optical_depth "$work/out") before"
runs 0 run "$work/scene.toml" --from "$work/tiled.hdf" -o "$work/large" --set time.end=0.02
prints "run" "particles                          2400"

refuses "an existing file" "exists already" tile "$small" 2 2 -o "$work/tiled.hdf"
accepts "an existing file" tile "$small" 2 2 -o "$work/tiled.hdf" --force
refuses "no copies" "'0' is not a number of copies from 1 to 10000" tile "$small" 0 2 -o "$work/none.hdf"
refuses "half a copy" "'1.5' is not a number of copies from 1 to 10000" tile "$small" 2 1.5 -o "$work/none.hdf"
refuses "a number missing" "NY is required" tile "$small" 2 -o "$work/none.hdf"
refuses "too oblong" "more than 1000 times as long as wide" tile "$small" 1 2000 -o "$work/none.hdf"
refuses "too many" "particles (the limit is 1e9)" tile "$small" 5000 5000 -o "$work/none.hdf"
refuses_with 4 "no file" "absent.hdf" tile "$work/absent.hdf" 2 2 -o "$work/none.hdf"
refuses_with 4 "a scene" "is no snapshot" tile "$work/scene.toml" 2 2 -o "$work/none.hdf"
refuses_with 4 "a checkpoint" "cannot read snapshot" tile "$(newest_checkpoint "$work/run")" 2 2 -o "$work/none.hdf"
[ -e "$work/none.hdf" ] && fail "a refused state was written"

report
