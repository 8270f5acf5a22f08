#!/bin/bash
# absurd.sh KEELER SOURCE_DIR: values that are finite but absurd, very long, or not text must end soon with one line and the
# right exit code. (They once caused endless steps, pages of messages, or a wrong exit code.) Start files are tested in
# tests/python/test_foreign_files.py, the environment of a run in hardening.sh and intrusions.sh.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed 's/^preset = .*/orbital_frequency = 2e-4/' "$work/scene.toml" >"$work/planet.toml"

# refused_by_all NAME WORDS ARGUMENT...: check and run refuse the scene, and no folder is made
refused_by_all() {
  local name=$1 words=$2
  shift 2
  refuses "$name, check" "$words" check "$@"
  refuses "$name, run" "$words" run "$@" -o "$work/none"
  [ -e "$work/none" ] && fail "$name: a folder was made"
  [ "$(stat -c %s "$work/err")" -lt 2100 ] || fail "$name: $(stat -c %s "$work/err") bytes of message"
}

for absurd in planet.orbital_frequency=1e-12 planet.orbital_frequency=1e200 planet.vertical_ratio=1e15; do
  refused_by_all "$absurd" "${absurd%%=*}" "$work/planet.toml" --set "$absurd"
done
for absurd in particles.density=1e12 particles.density=1e-300 particles.velocity_dispersion=1e6 particles.sizes.radius=1e100 \
  particles.sizes.radius=1e9 'box.size=[1e9,50]' time.end=1e300 time.end=1e18 particles.count=1e18 \
  gravity.opening_angle=1e-300; do
  refused_by_all "$absurd" "${absurd%%=*}" "$work/scene.toml" --set "$absurd"
done

# The length of a run is limited by the largest number of steps.
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.02
refuses "--until 1e18" "is too long" resume "$work/run" --until 1e18
refuses "--until 1e300" "is too long" resume "$work/run" --until 1e300

# Long values and bytes that are not text give a readable line.
/usr/bin/python3 -c 'print("x" * 1000000)' >"$work/long"
sed "s/^solver = .*/solver = \"$(head -c 100000 "$work/long")\"/" "$work/scene.toml" >"$work/long.toml"
refused_by_all "a long value" "gravity.solver" "$work/long.toml"
refused_by_all "a long value by --set" "gravity.solver" "$work/scene.toml" --set "gravity.solver=$(head -c 100000 "$work/long")"
{ cat "$work/scene.toml" && echo "[gravity.$(cat "$work/long")]"; } >"$work/key.toml"
refused_by_all "a long key" "unknown" "$work/key.toml"
sed 's/^solver = .*/solver = "tr\xff\x1b[31mee"/' "$work/scene.toml" >"$work/bytes.toml"
refused_by_all "bytes that are no text" "TOML" "$work/bytes.toml"
refused_by_all "the same by --set" "gravity.solver" "$work/scene.toml" --set "gravity.solver=$(printf 'tr\xff\x1b[31mee')"
LC_ALL=C grep -qP '[\x80-\xff\x1b]' "$work/err" && fail "raw bytes in: $(cat -v "$work/err")"

# Nesting depth, length and number of entries of a file.
/usr/bin/python3 - "$work" <<'END'
import sys
from pathlib import Path
work = Path(sys.argv[1])
scene = (work / "scene.toml").read_text()
for name, text in {
    "dots": "a." * 15000 + "b = 1\n",
    "tables": "[" + "a." * 15000 + "b]\n",
    "lists": "a = " + "[" * 100000 + "\n",
    "braces": "a = " + "{ b = " * 15000 + "1" + " }" * 15000 + "\n",
    "moonlets": scene + "[[moonlet]]\nradius = 1.0\ndensity = 900.0\n" * 20000,
    "aggregates": scene + "[[particles.aggregate]]\ncount = 1\n" * 20000,
    "modes": scene + "[particles.modes]\ninward = [" + "[1, 1e-7, 0.0], " * 200000 + "]\n",
    "grid": 'scene = "scene.toml"\nseeds = [' + ", ".join(map(str, range(1000000))) + "]\n",
    "deep_grid": 'scene = "scene.toml"\n[set]\n' + "a." * 15000 + "b = 1\n",
    "marked": "\ufeff" + scene,
    "rows.csv": "x,y,z,r\n" + "1.0,2.0,0.0,1.0\n" * 10000,
    "few_rows.csv": "x,y,z,r\n" + "1.0,2.0,0.0,1.0\n" * 2000,
    "marked_radii": "\ufeff1.0\n",
}.items():
    (work / (name if "." in name else name + ".toml")).write_text(text, encoding="utf-8")
END
refused_by_all "a deeply dotted key" "dots.toml:1:32: a name of more than 16 parts" "$work/dots.toml"
refused_by_all "a deeply dotted table" "a name of more than 16 parts" "$work/tables.toml"
refused_by_all "deep lists" "lists or tables inside each other, more than 16 deep" "$work/lists.toml"
refused_by_all "deep inline tables" "more than 16 deep" "$work/braces.toml"
refused_by_all "a deeply dotted --set" "more than 16 parts" "$work/scene.toml" --set "$(head -c 30000 "$work/dots.toml")b=1"
refused_by_all "a deep value by --set" "more than 16 deep" "$work/scene.toml" --set "box.size=$(head -c 30000 "$work/lists.toml" | tail -c 29000)"
refused_by_all "20,000 moonlets" "20000 tables [[moonlet]] are too many" "$work/moonlets.toml"
refused_by_all "20,000 aggregates" "20000 tables [[particles.aggregate]] are too many" "$work/aggregates.toml"
refused_by_all "200,000 modes" "[particles.modes] has 200000 modes" "$work/modes.toml"
refuses "a grid of a million runs" "the grid makes 1000000 runs" sweep "$work/grid.toml" -o "$work/none"
refuses "a deep grid" "a name of more than 16 parts" sweep "$work/deep_grid.toml" -o "$work/none"
refuses_with 3 "10,000 equal rows" "lie on each other in heaps" generate "$work/scene.toml" --from-table "$work/rows.csv" \
  --relax -o "$work/none.hdf"
refuses_with 3 "2,000 equal rows" "are a heap" generate "$work/scene.toml" --from-table "$work/few_rows.csv" --relax \
  -o "$work/none.hdf"
refuses "a file that does not end" "File too large" check /dev/zero
for command in info analyze "convert --to csv -o $work/none" "render -o $work/none.png"; do
  # shellcheck disable=SC2086 # a command and its options
  refuses_with 4 "a file that does not end, $command" "'/dev/zero': it is a pipe or a device" $command /dev/zero
done
refuses_with 4 "a table that does not end" "'/dev/zero': it is too large" generate "$work/scene.toml" -o "$work/none.hdf" \
  --from-table /dev/zero
truncate -s 3T "$work/large.hdf"
refuses_with 4 "a file larger than memory" "large.hdf': it is too large" info "$work/large.hdf"

runs 0 run "$work/scene.toml" -o "$work/deep" --set time.end=0.02
/usr/bin/python3 - "$work/deep/summary.json" <<'END'
import sys
from pathlib import Path
file = Path(sys.argv[1])
text = file.read_text()
deep = "[" * 200000 + "]" * 200000
file.write_text(text.replace('"ns_per_particle_step": {', '"ns_per_particle_step": ' + deep + ', "was": {', 1))
END
refuses_with 4 "deep JSON, report" "is not the summary of a run" report "$work/deep" -o "$work/none.html"
for command in "info --json" "analyze" "resume"; do
  code=0
  # shellcheck disable=SC2086 # a command and its option
  "$keeler" $command "$work/deep" >"$work/out" 2>"$work/err" || code=$?
  [ "$code" -lt 128 ] || fail "deep JSON, $command: exit $code"
done

# Plausible mistakes of a user.
accepts "a count with an exponent" check "$work/scene.toml" --set particles.count=1e2
prints "a count with an exponent" "particles                          100"
refused_by_all "a seed of 2^64 - 1" "particles.seed is 1.8446744073709552e+19, but must be a whole number from 0" \
  "$work/scene.toml" --set particles.seed=18446744073709551615
accepts "a scene with a byte order mark" check "$work/marked.toml"
accepts "radii with a byte order mark" check "$work/scene.toml" \
  --set "particles.sizes={law=\"file\",path=\"$work/marked_radii.toml\"}"

# The estimated cost of a scene is a finite number.
accepts "a long run" check "$work/scene.toml" --set time.end=1e9
prints "a long run" "time on one thread, an estimate    "
grep -qi 'inf\|nan' "$work/out" && fail "a long run: $(cat "$work/out")"

report
