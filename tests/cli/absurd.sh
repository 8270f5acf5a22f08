#!/bin/bash
# absurd.sh KEELER SOURCE_DIR: what once made steps that never ended, pages of messages, or a wrong exit code: values that are
# finite and absurd, long, or no text. Each is one line and the right exit code now, soon. What start files may hold is in
# tests/python/test_foreign_files.py, what happens around a run in hardening.sh and intrusions.sh.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed 's/^preset = .*/orbital_frequency = 2e-4/' "$work/scene.toml" >"$work/planet.toml"

# refused_by_all NAME WORDS ARGUMENT...: by check and by run, and no folder is made
refused_by_all() {
  local name=$1 words=$2
  shift 2
  refuses "$name, check" "$words" check "$@"
  refuses "$name, run" "$words" run "$@" -o "$work/none"
  [ -e "$work/none" ] && fail "$name: a folder was made"
  [ "$(wc -c <"$work/said")" -lt 2100 ] || fail "$name: $(wc -c <"$work/said") bytes of message"
}

for absurd in planet.orbital_frequency=1e-12 planet.orbital_frequency=1e200 planet.vertical_ratio=1e15; do
  refused_by_all "$absurd" "${absurd%%=*}" "$work/planet.toml" --set "$absurd"
done
for absurd in particles.density=1e12 particles.density=1e-300 particles.velocity_dispersion=1e6 particles.sizes.radius=1e100 \
  particles.sizes.radius=1e9 'box.size=[1e9,50]' time.end=1e300 time.end=1e18 particles.count=1e18 \
  gravity.opening_angle=1e-300; do
  refused_by_all "$absurd" "${absurd%%=*}" "$work/scene.toml" --set "$absurd"
done

# A run can be told to go on for as long as numbers of steps go, and no longer.
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.02
refuses "--until 1e18" "is too long" resume "$work/run" --until 1e18
refuses "--until 1e300" "is too long" resume "$work/run" --until 1e300

# Long values and bytes that are no text: a line that can be read.
python3 -c 'print("x" * 1000000)' >"$work/long"
sed "s/^solver = .*/solver = \"$(head -c 100000 "$work/long")\"/" "$work/scene.toml" >"$work/long.toml"
refused_by_all "a long value" "gravity.solver" "$work/long.toml"
refused_by_all "a long value by --set" "gravity.solver" "$work/scene.toml" --set "gravity.solver=$(head -c 100000 "$work/long")"
{ cat "$work/scene.toml" && echo "[gravity.$(cat "$work/long")]"; } >"$work/key.toml"
refused_by_all "a long key" "unknown" "$work/key.toml"
sed 's/^solver = .*/solver = "tr\xff\x1b[31mee"/' "$work/scene.toml" >"$work/bytes.toml"
refused_by_all "bytes that are no text" "TOML" "$work/bytes.toml"
refused_by_all "the same by --set" "gravity.solver" "$work/scene.toml" --set "gravity.solver=$(printf 'tr\xff\x1b[31mee')"
LC_ALL=C grep -qP '[\x80-\xff\x1b]' "$work/said" && fail "raw bytes in: $(cat -v "$work/said")"

# What a scene will cost is a number.
accepts "a long run" check "$work/scene.toml" --set time.end=1e9
prints "a long run" "time               about"
grep -qi 'inf\|nan' "$work/out" && fail "a long run: $(cat "$work/out")"

report
