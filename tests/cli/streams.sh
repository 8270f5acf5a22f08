#!/bin/bash
# streams.sh KEELER SOURCE_DIR: results are written to devices, pipes and standard output without replacing them; names that
# are in use (planted links, files of other programs, a second command) do no harm.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
accepts "a run" run "$work/scene.toml" -o "$work/run" --set time.end=0.3 --set output.series_every=0.01 -q
run=$work/run snapshot=$work/run/snap_000000.hdf

# Each command that writes a file: kind of the file, and the command without -o FILE or the like.
commands=("csv convert $snapshot --to csv -o" "vtp convert $snapshot --to vtp -o" "csv analyze $run --csv"
  "csv analyze $run --profile" "png render $snapshot --width 400 -o"
  "svg render $run --series -o" "html report $run -o" "toml new equilibrium -o")
refused=("hdf generate $work/scene.toml -o" "hdf tile $snapshot 2 1 -o")

# A null device, if one may be made: never the machine's.
null=$work/null
device=false
mknod "$null" c 1 3 2>/dev/null && (echo >"$null") 2>/dev/null && device=true
for command in "${commands[@]}" "${refused[@]}"; do
  read -ra words <<<"${command#* }"
  code=0
  [[ $command == hdf* ]] && code=2
  if $device; then
    runs "$code" "${words[@]}" "$null"
    [ -c "$null" ] || fail "$command: the device was replaced"
  fi
  mkfifo "$work/pipe"
  ln -s pipe "$work/link"
  timeout 20 cat "$work/pipe" >"$work/piped" &
  reader=$!
  runs "$code" "${words[@]}" "$work/link"
  [ "$code" -eq 0 ] || : >"$work/pipe" # its reader ends
  wait "$reader"
  if [ ! -p "$work/pipe" ] || [ ! -h "$work/link" ]; then fail "$command: the pipe was replaced"; fi
  rm "$work/pipe" "$work/link"
  for name in - /dev/stdout; do
    [[ $command == html* && $name == - ]] && continue # a page takes two seconds, and every command takes both names the same way
    if [ "$code" -eq 2 ]; then
      refuses "$command $name" "/dev/stdout' cannot take HDF5 (it is not a file on a disk" "${words[@]}" "$name"
      continue
    fi
    runs 0 "${words[@]}" "$name"
    [ -s "$work/piped" ] || fail "$command: nothing came through the pipe"
    cmp -s "$work/out" "$work/piped" || [[ $command == *report* ]] || fail "$command $name: another result than through a pipe"
  done
done
[ -h /dev/stdout ] || fail "/dev/stdout was replaced"

# If standard output is a file, output is appended at its position.
{ echo before; "$keeler" convert "$snapshot" --to csv -o -; echo after; } >"$work/redirected"
[ "$(head -n 1 "$work/redirected")/$(tail -n 1 "$work/redirected")" = before/after ] || fail "a redirected output was replaced"

# Results that cannot be streamed, or not together.
mkfifo "$work/movie.mp4"
refuses "a movie by ffmpeg" "movie.mp4' cannot take MP4" render "$run" --movie -o "$work/movie.mp4"
refuses "two results" "only one of --csv, --profile and --json" analyze "$run" --csv - --profile -
refuses "a table and JSON" "only one of --csv, --profile and --json" analyze "$run" --csv - --json
for command in "run $work/scene.toml" "sweep $work/scene.toml" "study kicks $work/scene.toml" "convert $run --to csv"; do
  read -ra words <<<"$command"
  refuses "$command -o -" "'-' is standard output, and the results are many files" "${words[@]}" -o -
  refuses "$command, no name" "is empty; name a folder" "${words[@]}" -o ""
done
refuses "no name" "the name of the file to write is empty" render "$run" -o ""
refuses_with 4 "a full device" "No space left on device" convert "$snapshot" --to csv -o /dev/full
"$keeler" convert "$snapshot" --to csv -o - 2>"$work/err" | true
[ "${PIPESTATUS[0]}" -eq 0 ] || one_line "a reader that goes" "Broken pipe"

# A snapshot cannot be read through a pipe, which gives no default name for a result either.
refuses_with 4 "info of a pipe" "it is a pipe or a device, and HDF5 needs random access" info /dev/stdin < <(cat "$snapshot")
refuses_with 4 "a table of a pipe" "name a file on a disk" convert /dev/stdin --to csv -o - < <(cat "$snapshot")
for command in render "convert --to csv"; do
  # shellcheck disable=SC2086 # a command and its options
  refuses "$command of a pipe without -o" "name the file to write with -o" $command /dev/stdin < <(cat "$snapshot")
done
accepts "a file as standard input" info /dev/stdin <"$snapshot"

# A pipe without a reader waits, and an interrupt ends that.
rm -f "$work/pipe"
mkfifo "$work/pipe"
"$keeler" convert "$snapshot" --to csv -o "$work/pipe" >"$work/out" 2>"$work/err" &
process=$!
sleep 0.5
kill -INT "$process"
code=0
wait "$process" || code=$?
[ "$code" -eq 1 ] || fail "a pipe without a reader: exit $code: $(cat "$work/err")"
one_line "a pipe without a reader" "stopped before all was written"

# Planted links are not followed, files of other programs are kept, and a replaced file keeps its permissions.
mkdir "$work/open"
echo secret >"$work/secret"
ln -s "$work/secret" "$work/open/a.toml.tmp"
ln -s "$work/secret" "$work/open/a.toml"
echo mine >"$work/open/b.toml.tmp"
echo old >"$work/open/b.toml"
chmod 600 "$work/open/b.toml"
for name in a b; do
  accepts "among links" new equilibrium --force -o "$work/open/$name.toml"
  cmp -s "$work/open/$name.toml" "$source_dir/examples/equilibrium/scene.toml" || fail "among links: another scene"
done
[ "$(cat "$work/secret")" = secret ] || fail "a link was followed"
[ "$(cat "$work/open/b.toml.tmp")" = mine ] || fail "a file of another program is gone"
[ "$(stat -c %a "$work/open/b.toml")" = 600 ] || fail "permissions: $(stat -c %a "$work/open/b.toml")"

# Two commands with one output name: the file is the complete result of one of them.
for k in 0 1; do
  accepts "a table" convert "$run/snap_00000$k.hdf" --to csv -o "$work/whole.$k"
done
for ((trial = 0; trial < 20; trial++)); do
  "$keeler" convert "$snapshot" --to csv --force -o "$work/one.csv" >/dev/null 2>"$work/err" &
  process=$!
  runs 0 convert "$run/snap_000001.hdf" --to csv --force -o "$work/one.csv"
  wait "$process" || fail "two commands onto one name: $(cat "$work/err")"
  cmp -s "$work/one.csv" "$work/whole.0" || cmp -s "$work/one.csv" "$work/whole.1" || fail "two commands onto one name: a mixture"
done

# The next command removes the partial files of a killed one.
echo torn >"$work/one.csv.keeler-0123456789abcdef.tmp"
accepts "after a kill" convert "$snapshot" --to csv --force -o "$work/one.csv"
compgen -G "$work/*.keeler-*.tmp" && fail "a part of a file was left"
report
