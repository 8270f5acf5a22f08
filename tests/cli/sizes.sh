#!/bin/bash
# sizes.sh KEELER SOURCE_DIR: numbers that determine sizes of arrays. Sizes beyond any memory, or beyond the range of integers,
# give one line with exit code 2 before anything is allocated. Other absurd numbers are tested in absurd.sh.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -e 's/^solver = .*/solver = "axisymmetric"/' "$work/scene.toml" >"$work/radial.toml"

# too_large NAME WORDS ARGUMENT...: the program ends with code 2 and one line, within 4 GB of address space and 20 s
too_large() {
  local name=$1 words=$2 code=0
  shift 2
  (
    ulimit -v 4000000
    exec timeout 20 "$keeler" "$@" >"$work/out" 2>"$work/err"
  ) || code=$?
  [ "$code" -eq 2 ] || fail "$name: exit $code instead of 2: $(head -c 300 "$work/err")"
  one_line "$name" "$words"
}

# Meshes of radial waves: the message has the scene's line, or the needed memory.
for short in 1e-18 1e-6 1e-300; do
  too_large "waves of $short m, check" "gravity.shortest_wavelength = $short m is too short" check "$work/radial.toml" \
    --set "gravity.shortest_wavelength=$short"
  too_large "waves of $short m, run" "gravity.shortest_wavelength = $short m is too short" run "$work/radial.toml" -o "$work/none" \
    --set "gravity.shortest_wavelength=$short"
  [ -e "$work/none" ] && fail "waves of $short m: a folder was made"
done
too_large "a mesh without memory" "GB of memory" run "$work/radial.toml" -o "$work/none" --set gravity.shortest_wavelength=5e-6
accepts "the same, check" check "$work/radial.toml" --set gravity.shortest_wavelength=5e-6 --json
[ "$(text memory_mb "$work/out" | cut -d . -f 1)" -gt 2000 ] || fail "a large mesh: check foretells $(text memory_mb "$work/out") MB"

# What a finer mesh adds to the memory estimated by check is what it adds to the memory of a run. The memory of the program itself
# cancels. Freed arrays go back to the system here: in the heap they may leave a gap as large as a mesh, which depends on as
# little as the length of a path.
foretells() { # SCENE KEY COARSE FINE
  local scene=$1 key=$2 value foretold=() taken=()
  for value in "$3" "$4"; do
    OMP_NUM_THREADS=1 runs 0 check "$work/$scene" --set "$key=$value" --json
    foretold+=("$(text memory_mb "$work/out")")
    MALLOC_MMAP_THRESHOLD_=1048576 runs 0 run "$work/$scene" --set "$key=$value" --set time.end=0.004 --threads 1 -o "$work/mesh" --force -q
    taken+=("$(text peak_memory_mb "$work/mesh/summary.json")")
  done
  awk -v f="$(awk "BEGIN { print ${foretold[1]} - ${foretold[0]} }")" -v t="$(awk "BEGIN { print ${taken[1]} - ${taken[0]} }")" \
    'BEGIN { exit !(f > 0.8 * t && f < 1.5 * t) }' ||
    fail "$scene, $key from $3 to $4: ${foretold[*]} MB foretold, ${taken[*]} MB taken"
}
foretells radial.toml gravity.shortest_wavelength 2 2e-4
sed -e 's/^solver = .*/solver = "mesh"/' "$work/scene.toml" >"$work/mesh.toml"
foretells mesh.toml gravity.mesh_spacing 1 0.1

# Particles.
too_large "a start of 1e9" "GB of memory" generate "$work/scene.toml" -o "$work/none.hdf" --set particles.count=1000000000 \
  --set 'box.size=[100000,100000]'
too_large "a run of 1e8" "GB of memory" run "$work/scene.toml" -o "$work/none" --set particles.count=100000000 --set 'box.size=[25000,25000]'
for bench in gravity step drift; do
  too_large "bench $bench" "GB of memory" bench $bench --count 1000000000 --repeats 1
  too_large "bench $bench, beyond" "is not a number of particles from 1 to" bench $bench --count 1000000000000000000
done
too_large "bench step, kicks" "is not a number of steps" bench step --count 500 --kick-every 2000000000
too_large "repeats" "is not a number of repeats" bench drift --count 500 --repeats 2000000000
too_large "study mesh" "is not a number above 0, up to" study mesh "$work/scene.toml" -o "$work/none" --orbits 1e300
too_large "study finders" "is not a number of particles" study finders -o "$work/none" --count 1e12

# Rays, footprints, gaps, pictures.
runs 0 generate "$work/scene.toml" -o "$work/start.hdf"
for footprint in 8.381903171539307e-09 1e-300 1e-6; do
  too_large "a footprint of $footprint m" "lower --rays or raise --footprint" analyze "$work/start.hdf" --elevation 30 --rays 1 \
    --footprint "$footprint"
done
too_large "rays" "lower --rays or raise --footprint" analyze "$work/start.hdf" --elevation 30 --rays 1000000000
too_large "a cluster gap" "is not a number above 0, up to 10" analyze "$work/start.hdf" --cluster-gap 1e300
too_large "a wide picture" "is not a number of pixels" render "$work/start.hdf" --width 20000

# A grid of a sweep is a product.
cat >"$work/grid.toml" <<END
scene = "scene.toml"
seeds = [1, 2, 3]
END
for key in time.end particles.density collisions.elastic_below_speed; do
  printf '[[axis]]\nkey = "%s"\nvalues = [%s]\n' "$key" "$(seq -s , 0.0001 0.0001 0.2)" >>"$work/grid.toml"
done
too_large "a grid" "the grid makes 2.4e10 runs" sweep "$work/grid.toml" -o "$work/none"

report
