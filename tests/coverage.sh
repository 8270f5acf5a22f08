#!/usr/bin/env bash
# Which lines of src/, lab/ and include/ the tests run: a table by file, and the share of all lines without src/cli, src/render and
# src/python, which must be 90 % at least.
#   scripts/test --coverage [ctest argument...]      for example: scripts/test --coverage -L unit
# build/coverage/coverage.txt has the sources with how often each line was run. Counted in the source by clang: gcov counts with
# atomic additions, for which threads wait so long that tests of seconds take minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup ci
cmake --preset coverage -DKEELER_TESTS=ON
cmake --build build/coverage
rm -rf build/coverage/profiles
# The processes of one program add their counts to one of four files. Whether tests pass is for other builds to say: where one
# limits the size of files, counts cannot be written, and clang's words on that are a line too many.
LLVM_PROFILE_FILE=$PWD/build/coverage/profiles/%4m.profraw ctest --test-dir build/coverage --parallel "$(nproc)" \
  --no-tests=error --label-exclude '^slow$' "$@" || true

# A process that a test killed while it wrote may leave a file that cannot be read.
llvm-profdata-14 merge --failure-mode=all --output build/coverage/all.profdata build/coverage/profiles/*.profraw
mapfile -t programs < <(find build/coverage -type f -executable ! -path '*/CMakeFiles/*' ! -name '*.so' | sort)
cover() { # VERB ARGUMENT...
  "llvm-cov-14" "$@" --instr-profile build/coverage/all.profdata --ignore-filename-regex '/(tests|src/cli|src/render|src/python)/|/build/[^/]*/(src|lab)/|/usr/' \
    "${programs[0]}" "${programs[@]/#/--object=}"
}
cover show --show-line-counts --show-branches=none >build/coverage/coverage.txt
cover report | tee build/coverage/report.txt
awk '$1 == "TOTAL" { lines = $8; missed = $9 } END {
  share = 100 * (1 - missed / lines)
  printf "lines run: %.1f %% of %d\n", share, lines
  exit share < 90 }' build/coverage/report.txt
