#!/usr/bin/env bash
# Which lines of src/ and include/ the tests run: a table by file, and the share of all lines without src/cli and src/render, which
# must be 90 % at least.
#   scripts/test --coverage [ctest argument...]      for example: scripts/test --coverage -L unit
# build/coverage/coverage.txt has the table with the lines that no test runs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup ci
cmake --preset coverage -DKEELER_TESTS=ON
cmake --build build/coverage
find build/coverage -name '*.gcda' -delete
failed=0
ctest --test-dir build/coverage --parallel "$(nproc)" --output-on-failure --no-tests=error --label-exclude '^slow$' "$@" || failed=1
gcovr --root . --object-directory build/coverage --gcov-executable "llvm-cov-14 gcov" --filter src/ --filter include/ \
  --exclude src/cli/ --exclude src/render/ --exclude src/python/ --fail-under-line 90 --print-summary \
  --output build/coverage/coverage.txt build/coverage || failed=1
exit $failed
