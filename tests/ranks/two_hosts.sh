#!/bin/bash
# two_hosts.sh FOLDER COMMAND...: runs the command on the first of two hosts, 10.0.7.1 and 10.0.7.2: network namespaces of this
# machine, each with a host name of its own, joined by a cable (keeler-1, keeler-2). mpirun --host 10.0.7.1:2,10.0.7.2:2 starts ranks
# on both, which talk by TCP alone, and gives up a host that is silent for 6 s. FOLDER/host holds the number of a process on
# the second host, FOLDER/agent runs a command there. The hosts end with the command. Exit code 77, with the reason, where
# namespaces are not permitted.
set -u
if [ "$1" != inside ]; then
  command -v ip >/dev/null || { echo "skipped: needs ip (Debian's iproute2)" >&2; exit 77; }
  as_root=()
  [ "$(id -u)" = 0 ] || as_root=(--map-root-user)
  unshare --net --uts "${as_root[@]}" true 2>/dev/null || { echo "skipped: network namespaces are not permitted here" >&2; exit 77; }
  exec unshare --net --uts "${as_root[@]}" bash "$0" inside "$@"
fi
folder=$2
shift 2

hostname keeler-1
unshare --net --uts sh -c 'hostname keeler-2 && exec sleep 1000' &
host=$!
trap 'kill -KILL $host' EXIT
until [ "$(cat /proc/$host/comm)" = sleep ]; do
  sleep 0.01
done
echo $host >"$folder/host"
{
  ip link set lo up
  ip link add keeler-1 type veth peer name keeler-2 netns $host
  ip address add 10.0.7.1/24 dev keeler-1
  ip link set keeler-1 up
  nsenter --target $host --net sh -c 'ip link set lo up && ip address add 10.0.7.2/24 dev keeler-2 && ip link set keeler-2 up'
} || { echo "skipped: no cable between two network namespaces" >&2; exit 77; }

# what mpirun starts in place of ssh: agent HOST WORDS...
cat >"$folder/agent" <<END
#!/bin/sh
shift
exec nsenter --target $host --net --uts sh -c "\$*"
END
chmod +x "$folder/agent"
export OMPI_MCA_plm_rsh_agent=$folder/agent OMPI_MCA_btl=tcp,self
export OMPI_MCA_btl_tcp_if_include=10.0.7.0/24 OMPI_MCA_oob_tcp_if_include=10.0.7.0/24
export OMPI_MCA_oob_tcp_keepalive_time=3 OMPI_MCA_oob_tcp_keepalive_intvl=1 OMPI_MCA_oob_tcp_keepalive_probes=3
export OMPI_MCA_mpi_yield_when_idle=1 # both hosts have the same processors
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
"$@"
