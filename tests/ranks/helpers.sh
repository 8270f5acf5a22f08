#!/bin/bash
# Functions of the tests that run the program on several ranks. Usage: source it with KEELER, SOURCE_DIR and MPIEXEC, end
# with `report`.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "${BASH_SOURCE[0]}")/../cli/helpers.sh"
mpiexec=$3
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 # containers of tests

# without files in memory, which a limit on the size of files would forbid
transport=(--mca btl 'self,tcp')
export PMIX_MCA_gds=hash

# on_ranks RANKS THREADS CODE ARGUMENT...: runs the program on RANKS ranks and checks its exit code; output as of runs(),
# without the launcher's lines
on_ranks() {
  local ranks=$1 threads=$2 expected=$3 code=0
  shift 3
  "$mpiexec" -n "$ranks" --oversubscribe --bind-to none "${transport[@]}" -x OMP_NUM_THREADS="$threads" "$keeler" "$@" \
    >"$work/out" 2>"$work/all" || code=$?
  grep -E '^keeler: |^[0-9.]+/[0-9.]+ orbits ' "$work/all" >"$work/err"
  [ "$code" -eq "$expected" ] || fail "$ranks ranks, $*: exit $code instead of $expected: $(tail -n 20 "$work/all")"
}

scene() { # NAME TEXT: writes a scene; adds the common keys
  cat - >"$work/$1.toml" <<END
title = "$1"
[planet]
preset = "saturn-a-ring"
$2
END
}
# same NAME FOLDER OTHER
same() {
  [ "$(state_hash "$2")" = "$(state_hash "$3")" ] || fail "$1: state_hash differs"
  same_series "$1" "$2" "$3"
  same_snapshots "$1" "$2" "$3"
  if [ -e "$2/moonlets.csv" ]; then
    cmp -s "$2/moonlets.csv" "$3/moonlets.csv" || fail "$1: moonlets.csv differs"
  fi
  if [ -e "$2/impact_speeds.csv" ]; then
    cmp -s "$2/impact_speeds.csv" "$3/impact_speeds.csv" || fail "$1: impact_speeds.csv differs"
    same_bytes "$1" /Contacts "$2/collisions_000000.h5" "$3/collisions_000000.h5"
  fi
}

# on_all_ranks NAME [ARGUMENT...]: a run of this scene has the files of one process on 2, 3, 4 and 8 ranks
on_all_ranks() {
  local name=$1 ranks count threads
  shift
  runs 0 run "$work/$name.toml" -o "$work/$name-1" "$@"
  for ranks in "2 1" "2 2" "3 1" "4 2" "8 1"; do
    read -r count threads <<<"$ranks"
    on_ranks "$count" "$threads" 0 run "$work/$name.toml" -o "$work/$name-$count-$threads" "$@"
    same "$name, $count ranks of $threads threads" "$work/$name-1" "$work/$name-$count-$threads"
  done
}
