#!/bin/bash
# contacts.sh KEELER SOURCE_DIR: the log of contacts does not depend on interruptions or on the number of threads. If it
# cannot be written the run ends with exit code 4 and one line, and can be continued.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
echo "collisions = {}" >>"$work/scene.toml" # in [output]

# same NAME FOLDER: log and state equal those of the uninterrupted run
same() {
  [ "$(state_hash "$work/whole")" = "$(state_hash "$2")" ] || fail "$1: another state"
  same_bytes "$1" /Contacts "$work/whole/collisions_000000.h5" "$2/collisions_000000.h5"
  cmp "$work/whole/impact_speeds.csv" "$2/impact_speeds.csv" || fail "$1: other impact speeds"
}

runs 0 run "$work/scene.toml" -o "$work/whole" --threads 1
[ "$(wc -l <"$work/whole/impact_speeds.csv")" -gt 20 ] || fail "few rows: $(cat "$work/whole/impact_speeds.csv")"
runs 0 info "$work/whole/collisions_000000.h5"
prints "info" "contact_count"
prints "info" "NormalSpeed"
runs 0 run "$work/scene.toml" -o "$work/two" --threads 2
same "two threads" "$work/two"

runs 0 run "$work/scene.toml" -o "$work/half" --set time.end=0.5
runs 0 resume "$work/half" --until 1
same "half and half" "$work/half"

interrupted KILL 137 "$work/killed"
runs 0 resume "$work/killed"
same "kill -9" "$work/killed"

# A folder has the name of the log.
runs 0 run "$work/scene.toml" -o "$work/blocked" --set time.end=0.5
mv "$work/blocked/collisions_000000.h5" "$work/kept.h5"
mkdir "$work/blocked/collisions_000000.h5"
refuses_with 4 "a folder in the way" "collisions_000000.h5" resume "$work/blocked" --until 1
rmdir "$work/blocked/collisions_000000.h5"
mv "$work/kept.h5" "$work/blocked/collisions_000000.h5"
runs 0 resume "$work/blocked" --until 1
same "a folder in the way" "$work/blocked"

refuses "a share of nothing" "output.collisions.fraction" check "$work/scene.toml" --set output.collisions.fraction=0
report
