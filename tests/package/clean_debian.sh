#!/usr/bin/env bash
# clean_debian.sh SOURCE_DIR FOLDER: Keeler's source archive, of the last commit, and the Debian packages made of it and installed
# on a Debian 12 that holds nothing else. The program follows the first page of the tutorial, as it was installed; ranks, the
# Python package and the library work; nothing is left after their removal. Then the same with what the Containerfile does, and
# without root. Needs root, debootstrap and the network, else it is skipped (77). FOLDER keeps the clean system for the next time.
set -euo pipefail
source_dir=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
packages=$folder/packages
clean=$folder/clean
system=$folder/system

[ "$(id -u)" = 0 ] || { echo "skipped: needs root"; exit 77; }
command -v debootstrap >/dev/null || { echo "skipped: needs debootstrap, which scripts/setup test installs"; exit 77; }
[ -n "${http_proxy-}" ] || getent hosts deb.debian.org >/dev/null || { echo "skipped: no network"; exit 77; }

# inside COMMAND...: in the system, which sees the folders `shared`; all mounts end with the command
shared=()
inside() {
  # shellcheck disable=SC2016 # for the other shell
  unshare --mount --propagation private sh -ec '
    system=$1; shift
    mount -t proc proc "$system/proc"
    mount --bind /dev "$system/dev"
    mount -t devpts devpts "$system/dev/pts" -o newinstance,ptmxmode=0666
    while [ "$1" != -- ]; do
      mkdir -p "$system$1"
      mount --bind "$1" "$system$1"
      shift
    done
    shift
    exec chroot "$system" "$@"' \
    sh "$system" "${shared[@]}" -- env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    ${http_proxy:+"http_proxy=$http_proxy"} ${https_proxy:+"https_proxy=$https_proxy"} DEBIAN_FRONTEND=noninteractive \
    "$@" </dev/null
}
fresh_system() {
  rm -rf "$system"
  cp -a "$clean" "$system"
  cp -L /etc/resolv.conf "$system/etc/"
  inside apt-get -qq update
}
install_packages() {
  inside sh -c "apt-get -qq install -y --no-install-recommends $* >/dev/null"
}

if [ ! -d "$clean" ]; then
  echo "=== a clean Debian"
  rm -rf "$clean.part"
  debootstrap --variant=minbase bookworm "$clean.part" http://deb.debian.org/debian >"$folder/debootstrap.log"
  mv "$clean.part" "$clean"
fi

echo "=== the source archive, and scripts/package from it"
"$source_dir/scripts/package" --source
archive=$(echo "$source_dir"/build/package/keeler-*.tar.gz)
commit=$(git get-tar-commit-id < <(gzip -dc "$archive")) # which reads no further than it needs
fresh_system
mkdir -p "$system$source_dir" # at the same path, which compiled objects in the cache depend on
tar -C "$system$source_dir" --strip-components 1 -xf "$archive"
cache=${CCACHE_DIR:-$HOME/.cache/ccache}
[ ! -d "$cache" ] || shared=("$cache")
inside env CCACHE_DIR="$cache" "$source_dir/scripts/package"
shared=()
rm -rf "$packages"
mkdir "$packages"
cp "$system$source_dir"/build/package/*.deb "$packages"

echo "=== keeler: the tutorial's first page"
fresh_system
cp "$packages"/*.deb "$system/tmp/"
install_packages '/tmp/keeler_*.deb'
mkdir "$system/srv/tutorial"
awk '/^## Your first patch/ { page = 1 } /^## A figure of your own/ { page = 0 }
     page && /^```toml/ { kind = "toml"; getline; print "cat >" $2 " <<\"END\"" }
     page && /^```sh/ { kind = "sh"; next }
     /^```$/ { if (kind == "toml") print "END"; kind = ""; next }
     kind { print }' "$system/usr/share/doc/keeler/docs/tutorial.md" >"$system/srv/tutorial/page"
inside sh -c 'cd /srv/tutorial && sh -ex page'
for file in first/summary.json first/picture.png without/summary.json; do
  [ -s "$system/srv/tutorial/$file" ] || { echo "FAILED: the tutorial left no $file"; exit 1; }
done
inside sh -c 'keeler check /usr/share/keeler/examples/a-ring-wakes/scene.toml'
inside sh -c 'keeler report /srv/tutorial/first'
grep -q 'THREE.' "$system/srv/tutorial/first/report.html" || { echo "FAILED: the report has no view"; exit 1; }

inside keeler run equilibrium -o /srv/first --set time.end=0.01 >/dev/null
grep -qF "$commit" "$system/srv/first/summary.json" || { echo "FAILED: the program does not name the commit $commit"; exit 1; }

echo "=== keeler-mpi"
install_packages '/tmp/keeler-mpi_*.deb'
inside useradd --create-home ringmaster
# shellcheck disable=SC2016 # for the other shell
inside su ringmaster -c 'cd && keeler run equilibrium -o one --set time.end=0.5 &&
  mpirun -n 2 --oversubscribe keeler-mpi run equilibrium -o two --set time.end=0.5 &&
  cp two/summary.json . && keeler resume two --until 1 && keeler-mpi resume one --until 1'
home=$system/home/ringmaster
[ "$(grep -h state_hash "$home"/{one,two}/summary.json | sort -u | wc -l)" = 1 ] ||
  { echo "FAILED: keeler and keeler-mpi have other bits"; exit 1; }
grep -q '"ranks": 2' "$home/summary.json" || { echo "FAILED: not two ranks"; exit 1; }

echo "=== python3-keeler, libkeeler-dev"
install_packages '/tmp/python3-keeler_*.deb /tmp/libkeeler-dev_*.deb' g++ make
inside python3 -c 'import keeler; print(keeler.program())'
inside sh -ec 'cp -r /usr/share/keeler/examples/embed /tmp/embed
  cmake -S /tmp/embed -B /tmp/embed/build && cmake --build /tmp/embed/build && /tmp/embed/build/embed'
inside sh -c 'apt-get -qq purge -y keeler keeler-mpi python3-keeler libkeeler-dev >/dev/null'
left=$(find "$system/usr" -path '*keeler*')
[ -z "$left" ] || { echo "FAILED: the packages leave $left"; exit 1; }

echo "=== what the Containerfile does"
fresh_system
cp "$packages"/*.deb "$system/tmp/"
run=$(sed -e :join -e '/\\$/{N;s/\\\n//;b join' -e '}' "$source_dir/Containerfile" | sed -n 's/^RUN \(.*apt-get.*\)/\1/p')
[ -n "$run" ] || { echo "FAILED: the Containerfile installs nothing"; exit 1; }
inside sh -c "$run"
inside su keeler -c 'cd && cp /usr/share/keeler/examples/equilibrium/scene.toml . &&
  keeler run scene.toml -o run --set time.end=1 && keeler render --movie run && test -s run/movie.mp4'
rm -rf "$system"
echo "passed"
