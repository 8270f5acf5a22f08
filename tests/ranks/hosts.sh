#!/bin/bash
# hosts.sh KEELER SOURCE_DIR MPIEXEC: a run on two hosts that talk by TCP has the bits of one process; when a host vanishes the
# run ends, and goes on from its last checkpoint to the same bits. The hosts are network namespaces (two_hosts.sh); skipped
# where they are not permitted (77).
if [ -z "${KEELER_HOSTS-}" ]; then
  KEELER_HOSTS=$(mktemp -d)
  export KEELER_HOSTS
  code=0
  bash "$(dirname "$0")/two_hosts.sh" "$KEELER_HOSTS" bash "$0" "$@" || code=$?
  rm -rf "$KEELER_HOSTS"
  exit $code
fi
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/../cli/helpers.sh"
mpiexec=$3
host=$(cat "$KEELER_HOSTS/host")

cat >"$work/scene.toml" <<END
title = "Two hosts"
[planet]
preset = "saturn-a-ring"
[box]
size = [60, 40] # m
[particles]
count = 500
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = "fft"
resting_contacts = "bounced"
[time]
step = 4e-3
end = 0.2
[output]
series_every = 0.02
snapshot_every = 0.1
checkpoint_every = 0.02
END

# on_hosts RANKS ARGUMENT...: runs the program on so many ranks of each host; $code is the exit code
on_hosts() {
  local ranks=$1
  shift
  code=0
  timeout 60 "$mpiexec" --host "10.0.7.1:$ranks,10.0.7.2:$ranks" --bind-to none -x OMP_NUM_THREADS=1 -x OMP_WAIT_POLICY=passive \
    "$keeler" "$@" >"$work/out" 2>"$work/err" </dev/null || code=$?
}

runs 0 run "$work/scene.toml" -o "$work/one"
for ranks in 1 2; do
  on_hosts $ranks run "$work/scene.toml" -o "$work/two-$ranks"
  [ $code -eq 0 ] || fail "$ranks ranks a host: exit $code: $(tail -n 5 "$work/err")"
  [ "$(state_hash "$work/one")" = "$(state_hash "$work/two-$ranks")" ] || fail "$ranks ranks a host: state_hash differs"
  same_series "$ranks ranks a host" "$work/one" "$work/two-$ranks"
  same_snapshots "$ranks ranks a host" "$work/one" "$work/two-$ranks"
done

# of_other_host: prints the processes of the second host but the one that holds it
of_other_host() {
  local network process
  network=$(readlink "/proc/$host/ns/net")
  for process in /proc/[0-9]*; do
    [ "$(readlink "$process/ns/net")" = "$network" ] && [ "${process#/proc/}" != "$host" ] && echo "${process#/proc/}"
  done
}

# A host loses its power, its daemon alone, or its cable: mpirun ends without success.
runs 0 run "$work/scene.toml" -o "$work/long" --set time.end=2
for loss in power daemon cable; do
  folder=$work/$loss
  (on_hosts 1 run "$work/scene.toml" -o "$folder" --set time.end=2; exit $code) &
  launcher=$!
  for _ in $(seq 600); do
    [ -n "$(newest_checkpoint "$folder" 2>/dev/null)" ] && break
    sleep 0.05
  done
  mapfile -t there < <(of_other_host)
  [ ${#there[@]} -ge 2 ] || fail "$loss: nothing works on the second host"
  case $loss in
    power) kill -KILL "${there[@]}" ;;
    daemon) for process in "${there[@]}"; do grep -qx orted "/proc/$process/comm" && kill -KILL "$process"; done ;;
    cable) ip link set keeler-1 down ;;
  esac
  code=0
  wait $launcher || code=$?
  [ $code -eq 124 ] && fail "$loss: the run hangs"
  [ $code -ne 0 ] || fail "$loss: exit 0, as if nothing had been"
  [ $loss != cable ] || ip link set keeler-1 up
  for process in "${there[@]}"; do
    kill -KILL "$process" 2>/dev/null # what the loss left on that host
  done
  runs 0 resume "$folder"
  [ "$(state_hash "$work/long")" = "$(state_hash "$folder")" ] || fail "$loss: state_hash differs"
  same_series "$loss" "$work/long" "$folder"
done
report
