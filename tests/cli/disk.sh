#!/bin/bash
# disk.sh KEELER SOURCE_DIR: on a full disk a run ends with exit code 4 and one line that says how to continue, its last
# checkpoint stays valid, and with free space again the run continues to the state of an uninterrupted run. The full disk is
# simulated by a limit on file size; where mounting is permitted, also by a disk of 600 KiB.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^end .*/end = 0.5/; s/^snapshot_every.*/snapshot_every = 0.05/; s/^checkpoint_every.*/checkpoint_every = 0.05/' \
  "$work/scene.toml"
runs 0 run "$work/scene.toml" -o "$work/whole"
expected=$(state_hash "$work/whole")

# goes_on NAME FOLDER: the newest checkpoint is valid, there are no partial files, and the run can be completed
goes_on() {
  runs 0 info "$(newest_checkpoint "$2")"
  compgen -G "$2/*.tmp" && fail "$1: a part of a file was left"
  tail -n 1 "$2/log.jsonl" | grep -q '}$' || fail "$1: a part of a line in the log"
  runs 0 resume "$2" --until 0.5
  [ "$(state_hash "$2")" = "$expected" ] || fail "$1: another state"
  cmp "$work/whole/series.csv" "$2/series.csv" || fail "$1: another series"
  [ "$(cd "$2" && echo *.hdf *.h5)" = "$(cd "$work/whole" && echo *.hdf *.h5)" ] || fail "$1: other files: $(ls "$2")"
}

# limited KIBIBYTES: resumes with a limit on the size of files
limited() {
  cp -r "$work/start" "$work/limited"
  (
    ulimit -f "$1"
    exec "$keeler" resume "$work/limited" --until 0.5 >"$work/out" 2>"$work/err"
  )
  code=$?
  [ "$code" -eq 4 ] || fail "limit of $1 KiB: exit $code: $(cat "$work/err")"
  one_line "limit of $1 KiB" "cannot write"
  one_line "limit of $1 KiB" "free some space, then continue with \"keeler resume $work/limited --until 0.5\""
  goes_on "limit of $1 KiB" "$work/limited"
  rm -rf "$work/limited"
}

runs 0 run "$work/scene.toml" -o "$work/start" --set time.end=0.2
limited 1  # the scene fits, the series does not
limited 40 # snapshots and checkpoints do not fit

# A disk that is full before the first checkpoint: the message says so, and so does resume.
(
  ulimit -f 20
  exec "$keeler" run "$work/scene.toml" -o "$work/early" >"$work/out" 2>"$work/err"
)
code=$?
[ "$code" -eq 4 ] || fail "no room for the first snapshot: exit $code: $(cat "$work/err")"
one_line "no room for the first snapshot" "free some space, then start again with --force (there is no checkpoint yet)"
refuses_with 4 "no checkpoint yet" "start again with \"keeler run\" and --force" resume "$work/early"
runs 0 run "$work/scene.toml" -o "$work/early" --force
[ "$(state_hash "$work/early")" = "$expected" ] || fail "started again: another state"

# Runs a command in a new mount namespace, as root or as root of a user namespace.
# shellcheck disable=SC2016 # that shell expands it
on_small_disk='mount -t tmpfs -o size=600k none "$2/disk" || exit 99
  "$1" run "$2/scene.toml" -o "$2/disk/run" >"$2/out" 2>"$2/err"
  code=$?
  cp -r "$2/disk/run" "$2/full" && exit $code'
mkdir "$work/disk"
code=99
for options in "-m" "-rm"; do
  unshare "$options" true 2>/dev/null || continue
  code=0
  unshare "$options" bash -c "$on_small_disk" bash "$keeler" "$work" || code=$?
  break
done
if [ "$code" -eq 99 ]; then
  echo "SKIPPED: a full disk (mounting is not permitted here); the limits on file size were tested"
else
  [ "$code" -eq 4 ] || fail "full disk: exit $code: $(cat "$work/err")"
  one_line "full disk" "No space left on device; free some space, then continue with \"keeler resume "
  [ "$(find "$work/full" -name 'checkpoint_*.h5' | wc -l)" -eq 2 ] || fail "full disk: $(ls "$work/full")"
  goes_on "full disk" "$work/full"
fi

report
