#!/usr/bin/env bash
# Fuzzes the readers with libFuzzer, one target after the other, in one process at a time.
#   scripts/test --fuzz[=MINUTES] [TARGET...]      30 minutes each; all targets
# Prints a line of a table for each (minutes, inputs run, inputs a second, findings, corpus) and keeps what it finds in
# build/fuzz/found/TARGET, the corpus in build/fuzz/corpus/TARGET. At the end all findings are replayed; 1 when one breaks
# Keeler. What breaks HDF5 alone, in `foreign`, does not: it is read by a child process.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

minutes=${1:-30}
shift
targets=("$@")
if [ $# -eq 0 ]; then
  for folder in tests/fuzz/corpus/*/; do
    targets+=("$(basename "$folder")")
  done
fi

scripts/setup ci
cmake --preset fuzz -DKEELER_TESTS=ON
cmake --build build/fuzz --target fuzz replay

bin=build/fuzz/tests/fuzz
found=build/fuzz/found
work=$(mktemp -d /dev/shm/keeler-fuzzing-XXXXXX)
trap 'rm -rf "$work"' EXIT
export KEELER_FUZZ_FOLDER=$work ASAN_OPTIONS=detect_leaks=0 # HDF5 keeps what damaged files made it take
mkdir "$work/examples"
for scene in examples/*/scene.toml examples/papers/*/scene.toml; do
  cp "$scene" "$work/examples/$(basename "$(dirname "$scene")")"
done

printf '| target | minutes | inputs | a second | findings | corpus |\n|---|---|---|---|---|---|\n'
for target in "${targets[@]}"; do
  corpus=build/fuzz/corpus/$target
  mkdir -p "$corpus" "$found/$target"
  seeds=("tests/fuzz/corpus/$target")
  if [ "$target" = scene ]; then
    seeds+=("$work/examples")
  fi
  # what grows with depth, length or number is found by inputs of some size; a folder is a list of short edits
  longest=65536
  if [ "$target" = folder ]; then
    longest=4096
  fi
  log=build/fuzz/$target.log
  nice -n 15 "$bin/fuzz" "--target=$target" -fork=1 -ignore_crashes=1 -ignore_timeouts=1 -ignore_ooms=1 -timeout=10 \
    "-max_len=$longest" -rss_limit_mb=3000 "-max_total_time=$((60 * minutes))" "-artifact_prefix=$found/$target/" "$corpus" "${seeds[@]}" \
    >"$log" 2>&1 || [ $? -eq 77 ] || { tail -n 20 "$log" >&2; exit 1; } # 77: with findings
  inputs=$(grep -oE '^#[0-9]+: cov' "$log" | tail -n 1 | tr -dc '0-9')
  printf '| %s | %s | %s | %s | %s | %s files, %s kB |\n' "$target" "$minutes" "${inputs:-0}" \
    $((${inputs:-0} / (60 * minutes))) "$(find "$found/$target" -type f | wc -l)" \
    "$(find "$corpus" -type f | wc -l)" $(($(du -sb "$corpus" | cut -f 1) / 1000))
done
if ! "$bin/replay" "$found" >"$work/replay.log" 2>&1; then
  tail -n 30 "$work/replay.log" >&2
  echo "fuzz: Keeler breaks on a finding, the last one named above; mend it and put it into tests/fuzz/corpus" >&2
  exit 1
fi
echo "fuzz: no finding breaks Keeler; those of HDF5, if any, are in $found"
