#!/bin/bash
# damage.sh KEELER SOURCE_DIR: resume skips a damaged checkpoint with a message, continues from the older one and reaches the
# same final state; without any undamaged checkpoint it ends with exit code 4.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.3/' "$work/scene.toml"

change_a_byte() {
  local place=$(($(stat -c %s "$1") / 2)) byte
  byte=$(od -An -tu1 -j "$place" -N 1 "$1")
  # shellcheck disable=SC2059 # the format is the byte
  printf "\\x$(printf %02x $((byte ^ 1)))" | dd of="$1" bs=1 seek="$place" conv=notrunc status=none
}
cut_short() { truncate -s -100 "$1"; }
make_empty() { truncate -s 0 "$1"; }
replace_by_text() { echo "not a checkpoint" >"$1"; }

runs 0 run "$work/scene.toml" -o "$work/whole"
expected=$(state_hash "$work/whole")

for harm in change_a_byte cut_short make_empty replace_by_text; do
  rm -rf "$work/hurt"
  cp -r "$work/whole" "$work/hurt"
  newest=$(newest_checkpoint "$work/hurt")
  $harm "$newest"
  refuses_with 4 "$harm, info" "$(basename "$newest")" info "$newest"
  runs 0 resume "$work/hurt"
  one_line "$harm" "$(basename "$newest")"
  [ "$(state_hash "$work/hurt")" = "$expected" ] || fail "$harm: another state"
  cmp "$work/whole/series.csv" "$work/hurt/series.csv" || fail "$harm: another series"
  [ "$(ls "$work/hurt")" = "$(ls "$work/whole")" ] || fail "$harm: other files: $(ls "$work/hurt")"
done

for checkpoint in "$work"/hurt/checkpoint_*; do
  change_a_byte "$checkpoint"
done
refuses_with 4 "all damaged" "no checkpoint in" resume "$work/hurt"
rm "$work"/hurt/checkpoint_*
refuses_with 4 "no checkpoint" "no checkpoint in" resume "$work/hurt"
refuses_with 4 "no folder" "absent" resume "$work/absent"

cp "$work/whole/snap_000001.hdf" "$work/snap.hdf"
change_a_byte "$work/snap.hdf"
for command in info analyze render "run $work/scene.toml -o $work/none --from"; do
  # shellcheck disable=SC2086 # several words
  runs 4 $command "$work/snap.hdf"
  grep -q "^keeler: .*snap.hdf" "$work/err" || fail "$command of a damaged snapshot: $(cat "$work/err")"
done
[ -e "$work/none" ] && fail "a folder for a run that cannot start"

report
