#!/bin/bash
# table.sh KEELER SOURCE_DIR: a start from a user's table of particles, and all faults of such tables.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
cat >"$work/scene.toml" <<END
[planet]
orbital_frequency = 1.95e-4
[box]
size = [60, 40]
[collisions]
restitution = { law = "constant", value = 0.5 }
[time]
end = 0.01
END
cat >"$work/good.csv" <<END
x,y,z,vx,vy,vz,r,m
0,0,0,0,0,0,1,4000
10,5,0.5,1e-4,-2.925e-3,0,2,30000

-20,15,0,0,5.85e-3,1e-4,1.5,13000
END

# made LINE...: writes a table with these lines
made() { printf '%s\n' "$@" >"$work/table.csv"; }
# refused CODE NAME WORDS: the table is refused
refused() {
  refuses_with "$1" "$2" "$3" generate "$work/scene.toml" --from-table "$work/table.csv" -o "$work/none.hdf"
  [ -e "$work/none.hdf" ] && fail "$2: wrote a state"
}

runs 0 generate "$work/scene.toml" --from-table "$work/good.csv" -o "$work/good.hdf"
prints "a good table" "3 particles in 60 m x 40 m, no overlaps: $work/good.hdf"
accepts "info" info "$work/good.hdf" --json
prints "the scene in the file starts from it" "from = \\\"$work/good.hdf\\\""
runs 0 run "$work/scene.toml" --from "$work/good.hdf" -o "$work/run"
prints "run" "particles                          3"

made x,y,z,r 0,0,0,1 10,0,0,1
refused 2 "no masses" "no column m, and the scene has no particles.density"
runs 0 generate "$work/scene.toml" --set particles.density=900 --from-table "$work/table.csv" -o "$work/circular.hdf"
grep -qF "note: the table has no velocities: all orbits are circular" "$work/err" || fail "circular: $(cat "$work/err")"

made x,y,r,m 0,0,1,4000
refused 2 "a column missing" "table.csv:1: the column 'z' is missing; add it (the columns are x y z vx vy vz r, m, and sx sy sz)"
made x,y,z,vx,r,m 0,0,0,0,1,4000
refused 2 "half of the velocities" "table.csv:1: the column 'vy' is missing"
made name,x,y,z,r,m 0,0,0,0,1,4000
refused 2 "an unknown column" "table.csv:1: unknown column 'name'; rename or remove it"
made x,y,z,r,m 0,0,0,1,4000 5,5,5,nan,4000
refused 2 "nan" "table.csv:3: the particle has a radius (m) of nan"
made x,y,z,r,m 0,nan,0,1,4000
refused 2 "a place that is nan" "table.csv:2: the particle has a position or a velocity that is not finite"
made x,y,z,r,m 0,0,0,-1,4000
refused 2 "a negative radius" "table.csv:2: the particle has a radius (m) of -1 (possible is from 1e-6 to 1000000); correct it"
made x,y,z,r,m 0,0,0,1,0
refused 2 "no mass" "table.csv:2: the particle has a density (kg/m^3, by its mass and radius) of 0"
made x,y,z,r,m 0,0,0,1,4000 300,0,0,1,4000
refused 2 "outside" "table.csv:3: the particle has x = 300, y = 0 outside the box of 60 m x 40 m about 0"
made x,y,z,r,m
refused 2 "an empty table" "table.csv: the table is empty (a start needs a particle); add a row for each"
: >"$work/table.csv"
refused 2 "an empty file" "table.csv: the table is empty (not even columns are named)"
made x,y,z,r,m 0,0,0,1,4000 1,2,3
refused 2 "a short row" "table.csv:3: the row has 3 of 5 values (line 1 names the columns); correct or remove it"
made x,y,z,r,m 0,0,zero,1,4000
refused 2 "a word" "table.csv:2: z is 'zero' (it must be a number)"
made 0,0,0,1,4000
refused 2 "no names" "table.csv:1: the first row has numbers (it must name the columns)"
made x,y,z,r,m 0,0,0,100,4e9
refused 2 "a particle wider than the box" "table.csv:2: the particle has a diameter of 200 m, larger than the width of the box (40 m)"
rm "$work/table.csv"
refused 4 "no file" "table.csv"
printf '\211HDF\r\n\032\nrubbish' >"$work/table.csv"
refused 4 "damaged HDF5" "as HDF5"

made x,y,z,r,m 0,0,0,1,4000 1.5,0,0,1,4000 10,10,0,1,4000 29.9,0,0,1,4000 -29.9,0,0,1,4000
refused 3 "overlaps" "2 pairs of particles overlap, most of all $work/table.csv:5 and $work/table.csv:6, by 0.9 of their radius sum; that pair meets across an edge of the box: is the shear offset right (0 m here; a CSV has none, the other formats of keeler convert keep it), and is the box that of the particles?; correct them, or move them apart with --relax"
runs 0 generate "$work/scene.toml" --from-table "$work/table.csv" --relax -o "$work/relaxed.hdf"
prints "relaxed" "2 pairs of particles overlap"
prints "relaxed" "moved 4 particles apart, by "
runs 0 run "$work/scene.toml" --from "$work/relaxed.hdf" -o "$work/relaxed"

# A table named in the scene, and tables unlike any ring: velocities without the shear or in other units, lengths in km.
/usr/bin/python3 - "$work" <<'END'
import random, sys
random.seed(3)
spots = [(x, y) for x in range(-28, 30, 4) for y in range(-18, 20, 4)]
places = [(x, y, random.gauss(0, 0.3)) for x, y in spots]
omega = 1.95e-4
motions = [(random.gauss(0, 2 * omega), random.gauss(0, omega), random.gauss(0, 1.3 * omega)) for _ in places]
def table(name, velocities, length=1.0):
    with open(f"{sys.argv[1]}/{name}.csv", "w") as file:
        file.write("x,y,z,vx,vy,vz,r\n")
        for p, v in zip(places, velocities):
            file.write(",".join(map(repr, [c * length for c in p] + list(v) + [length])) + "\n")
ring = [(u, v - 1.5 * omega * x, w) for (x, _, _), (u, v, w) in zip(places, motions)]
table("ring", ring)
table("still", motions)
table("mirrored", [(u, v + 1.5 * omega * x, w) for (x, _, _), (u, v, w) in zip(places, motions)])
table("cm_s", [tuple(100 * c for c in v) for v in ring])
table("hot", [(u + random.gauss(0, 99 * omega), v, w) for u, v, w in ring])
table("km", ring, 1e-3)
END
generated() { runs 0 generate "$work/scene.toml" --set particles.density=900 --from-table "$work/$1.csv" -o "$work/$1.hdf" --force; }
far() { # NAME WORDS: said by generate, by check and by run of a start from it
  generated "$1"
  prints "$1, generate" "$2"
  runs 0 check "$work/scene.toml" --set start.from="$work/$1.hdf"
  prints "$1, check" "$2"
  runs 0 run "$work/scene.toml" --from "$work/$1.hdf" --set time.end=0.001 -o "$work/$1"
  grep -qF "$2" "$work/err" || fail "$1, run: $(cat "$work/err")"
}
far still "the velocities lack the shear: dv_y/dx is "
far mirrored "the shear of the velocities has the wrong sign"
far cm_s "that of circular orbits (-0.0002925): are lengths in m and velocities in m/s"
far hot "mean r Omega); collisions and self-gravity maintain about 3.6: are velocities in m/s"
far km "all particles are in the central 0.093 % of the box: are positions and the box in m"
generated ring
grep -q "shear\|are lengths\|are velocities" "$work/out" && fail "a ring is doubted: $(cat "$work/out")"
runs 0 check "$source_dir/examples/two-body/scene.toml"
grep -q "shear\|are lengths\|are velocities" "$work/out" && fail "two bodies are doubted: $(cat "$work/out")"
runs 0 check "$work/scene.toml" --set particles.density=900 --set particles.count=50 --set particles.sizes.law=equal \
  --set particles.sizes.radius=1 --set particles.velocity_dispersion=200
prints "a hot fresh start" "the velocity dispersion is 39 mm/s (200 mean r Omega); collisions"

made x,y,z,r,m, 0,0,0,1,4000,
refused 2 "a trailing comma" "table.csv:1: the last column has no name (the line ends with a ','); remove it here"
made ,x,y,z,r,m 0,0,0,0,1,4000
refused 2 "an index of pandas" "table.csv:1: the first column has no name (pandas writes its index so); write the table with index=False"

made x,y,z,r,m,sx,sy,sz 0,0,0,1,4000,1e-4,0,-2e-4 10,10,0,1,4000,0,0,3e-4
refused 2 "spins of smooth particles" "table.csv: sx sy sz are spins, but the scene's particles are smooth"
runs 0 generate "$work/scene.toml" --set collisions.friction.tangential_restitution=0.5 --from-table "$work/table.csv" \
  -o "$work/rough.hdf"
h5dump -d /PartType1/Spins "$work/rough.hdf" >"$work/spins"
grep -qF "(1,0): 0, 0, 0.0003" "$work/spins" || fail "spins: $(cat "$work/spins")"
made x,y,z,r,m,sz 0,0,0,1,4000,1e-4
refused 2 "a part of the spins" "table.csv:1: the column 'sx' is missing; add it"

made '#x,y,z,r,m' '# made by me' 0,0,0,1,4000
runs 0 generate "$work/scene.toml" --from-table "$work/table.csv" -o "$work/comments.hdf"
printf 'x,y,z,r\n0,0,0,1\n' | iconv -t UTF-16 >"$work/table.csv"
refused 2 "UTF-16" "table.csv: is a text in UTF-16 (its byte order mark says so); save it as UTF-8"
printf 'x,y,z,r\n\0\0,0,0,1\n' >"$work/table.csv"
refused 2 "zero bytes" "table.csv:2: x is '??' (it must be a number); correct it or remove the row"

made x,y,z,r,m 0,0,0,1,4000
refuses "a start beside it" "start.from cannot be combined with a table of particles" \
  generate "$work/scene.toml" --set start.from="$work/good.hdf" --from-table "$work/table.csv" -o "$work/none.hdf"
sed 's/^size = .*/size_in_wavelengths = [4, 4]/' "$work/scene.toml" >"$work/wavelengths.toml"
refuses "a box in wavelengths" "box.size_in_wavelengths cannot be combined with a table" \
  generate "$work/wavelengths.toml" --from-table "$work/table.csv" -o "$work/none.hdf"
refuses "--relax alone" "--relax requires --from-table" generate "$work/scene.toml" --relax -o "$work/none.hdf"
refuses "an existing file" "exists already" generate "$work/scene.toml" --from-table "$work/table.csv" -o "$work/good.hdf"
[ -e "$work/none.hdf" ] && fail "a refused state was written"

report
