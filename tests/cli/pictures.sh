#!/bin/bash
# pictures.sh KEELER SOURCE_DIR: pictures and movies that fail or are stopped end with one line and leave no partial file; a
# long movie shows its progress on a terminal.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.02 --set output.snapshot_every=0.01
mkdir "$work/empty" "$work/to" "$work/disk"

# nothing_left NAME: there are no partial results in $work/to or beside the run's files
nothing_left() {
  [ -z "$(ls -A "$work/to")" ] || fail "$1: left $(ls -A "$work/to")"
  compgen -G "$work/run/*.tmp" && fail "$1: left a part of a file"
}

refuses_with 4 "a picture of an empty folder" "no snapshot in '$work/empty' (snap_NNNNNN.hdf is missing); name" render "$work/empty"
refuses_with 4 "a movie of an empty folder" "no snapshot in '$work/empty' (snap_NNNNNN.hdf is missing); name" \
  render "$work/empty" --movie
refuses "a movie of a file" "name the folder of a run" render "$work/run/snap_000000.hdf" --movie
refuses "another movie" "movies are .mp4 files; give it that ending" render "$work/run" --movie -o "$work/to/a.png"
refuses "another picture" "give it that ending" render "$work/run" -o "$work/to/a.jpg"
refuses "plots of a file" "name the folder of a run" render "$work/run/snap_000000.hdf" --series
refuses "plots as a photograph" "give it one of these endings" render "$work/run" --series -o "$work/to/a.jpg"
refuses "plots and a movie" "excludes" render "$work/run" --series --movie
refuses_with 4 "plots of an empty folder" "log.jsonl is missing" render "$work/empty" --series
cp -r "$work/run" "$work/short"
sed -i '3,$d' "$work/short/series.csv"
refuses "plots of a row" "let it run longer" render "$work/short" --series

# Only a picture, a movie, a page or a table with equal columns is replaced.
cp -r "$work/run" "$work/kept"
# keeps FILE COMMAND...: the command does not overwrite this file
keeps() {
  local file=$1
  shift
  refuses "$* over $file" "exists already and is not" "$@" "$work/run/$file"
  cmp -s "$work/run/$file" "$work/kept/$file" || fail "$*: $file is another one"
}
cp "$work/run/series.csv" "$work/run/series.png"
cp "$work/run/series.csv" "$work/run/series.mp4"
cp "$work/run/series.png" "$work/run/series.mp4" "$work/kept"
cp "$work/run/series.csv" "$work/run/series.svg"
cp "$work/run/series.csv" "$work/kept/series.svg"
keeps series.svg render "$work/run" --series -o
rm "$work/run/series.svg"
keeps series.png render "$work/run" -o
keeps series.png render "$work/run" --series -o
keeps series.mp4 render "$work/run" --movie -o
keeps snap_000000.hdf report "$work/run" -o
keeps scene.toml analyze "$work/run/snap_000000.hdf" --profile
keeps series.csv analyze "$work/run/snap_000000.hdf" --csv
rm "$work/run/series.png" "$work/run/series.mp4"
for _ in 1 2; do
  runs 0 render "$work/run" -o "$work/picture.png"
  runs 0 render "$work/run" --movie -o "$work/again.mp4"
  for ending in svg png pdf; do
    runs 0 render "$work/run" --series --width 900 -o "$work/again.$ending"
    prints "plots" "$work/again.$ending"
  done
  runs 0 report "$work/run" -o "$work/again.html"
  no_controls "report"
  runs 0 analyze "$work/run/snap_000000.hdf" --csv "$work/again.csv"
done
/usr/bin/python3 - "$work" <<'END' || fail "files of plots"
import pathlib, struct, sys, xml.etree.ElementTree
folder = pathlib.Path(sys.argv[1])
svg = xml.etree.ElementTree.parse(folder / "again.svg").getroot()
png = (folder / "again.png").read_bytes()
assert svg.get("width") == "900px" and "time (orbits)" in svg.find("{http://www.w3.org/2000/svg}desc").text.split("\n")
assert png.startswith(b"\x89PNG") and struct.unpack(">I", png[16:20]) == (900,)
assert (folder / "again.pdf").read_bytes().startswith(b"%PDF-")
END

code=0
PATH=$work "$keeler" render "$work/run" --movie -o "$work/to/a.mp4" >"$work/out" 2>"$work/err" || code=$?
[ "$code" -eq 2 ] || fail "no ffmpeg: exit $code"
one_line "no ffmpeg" "the program ffmpeg is not on PATH; install the package ffmpeg"
printf '#!/bin/sh\necho this one is broken >&2\nexit 1\n' >"$work/ffmpeg"
chmod +x "$work/ffmpeg"
code=0
PATH=$work:$PATH "$keeler" render "$work/run" --movie -o "$work/to/a.mp4" >"$work/out" 2>"$work/err" || code=$?
[ "$code" -eq 4 ] || fail "a broken ffmpeg: exit $code"
one_line "a broken ffmpeg" "ffmpeg says: this one is broken; choose a folder that is writable and has room"
nothing_left "refused"

# limited NAME FILE COMMAND OPTION...: writes the file under a limit on the size of files
limited() {
  (
    ulimit -f 8
    exec "$keeler" "$3" "$work/run" -o "$work/to/$2" "${@:4}" >"$work/out" 2>"$work/err"
  )
  code=$?
  [ "$code" -eq 4 ] || fail "$1: exit $code: $(cat "$work/err")"
  one_line "$1" "cannot write"
  nothing_left "$1"
}
limited "no room for a picture" a.png render
limited "no room for a movie" a.mp4 render --movie
for ending in svg png pdf; do limited "no room for plots" a.$ending render --series; done
limited "no room for a page" a.html report

# A long movie: many copies of one snapshot.
for number in $(seq 1000 1300); do ln "$work/run/snap_000000.hdf" "$work/run/snap_00$number.hdf"; done

# Where mounting is permitted: a disk that fills in the middle.
# shellcheck disable=SC2016 # that shell expands it
on_small_disk='mount -t tmpfs -o size=20k none "$2/disk" || exit 99
  "$1" render "$2/run" --movie --width 400 -o "$2/disk/$3" >"$2/out" 2>"$2/err"
  code=$?
  ls -A "$2/disk" >"$2/left" && exit $code'
for options in "-m" "-rm"; do
  unshare "$options" true 2>/dev/null || continue
  code=0
  unshare "$options" bash -c "$on_small_disk" bash "$keeler" "$work" a.mp4 || code=$?
  [ "$code" -eq 99 ] && echo "SKIPPED: a full disk (mounting is not permitted here)" && break
  [ "$code" -eq 4 ] || fail "a disk that fills: exit $code: $(cat "$work/err")"
  one_line "a disk that fills" "No space left on device"
  [ -s "$work/left" ] && fail "a disk that fills: left $(cat "$work/left")"
  break
done

# Ctrl-C reaches all processes of a terminal.
setsid "$keeler" render "$work/run" --movie -o "$work/to/a.mp4" >"$work/out" 2>"$work/err" &
process=$!
until [ -s "$(compgen -G "$work/to/a.mp4.keeler-*.tmp")" ] || ! kill -0 "$process" 2>/dev/null; do sleep 0.01; done
kill -INT -- "-$process"
code=0
wait "$process" || code=$?
[ "$code" -eq 1 ] || fail "an interrupted movie: exit $code: $(cat "$work/err")"
one_line "an interrupted movie" "stopped before all was drawn"
nothing_left "an interrupted movie"

rm "$work"/run/snap_001[12]*.hdf # enough for a line of progress
/usr/bin/python3 "$source_dir/tests/cli/terminal.py" 40 "$keeler" render "$work/run" --movie --width 400 -o "$work/to/a.mp4" >"$work/drawn" 2>"$work/err" ||
  fail "a movie on a terminal: $(cat "$work/err")"
grep -q " left  pictures" "$work/drawn" || fail "no progress of a movie: $(cat "$work/drawn")"
report
