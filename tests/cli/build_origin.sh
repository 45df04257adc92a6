# --origin: a corner of voxels is there, planes are whole steps from it, and bakes with one origin agree voxel by voxel.
svdag-scene city -n 6K -q -o a.ply
svdag build a.ply -o a.svdag -s 0.3 --origin 0.1,-7,1e3 -q
svdag info a.svdag | grep -v hash | head -4
svdag-verify check a.svdag
svdag-verify mesh a.svdag a.ply | head -1
svdag-verify mesh a.svdag a.ply | tail -1
python3 - <<'PY'
import json, subprocess, sys
grid = json.loads(subprocess.run(["svdag", "info", "a.svdag", "--json"], capture_output=True, text=True).stdout)["grid"]
print(grid["kind"], grid["origin"], [c == o + k * 0.3 for c, o, k in zip(grid["corner"], grid["origin"], grid["k0"])])
PY
# A part of the same world, with and without the origin's help.
svdag build a.ply -o part.svdag -s 0.3 --origin 0.1,-7,1e3 --bounds=-10,0,-10,10,5,10 -q
svdag edit a.svdag -o cut.svdag --bounds=-10,0,-10,10,5,10 -q
for name in part cut; do svdag export $name.svdag -o $name.npz -q; done
python3 - <<'PY'
import numpy
world = []
for name in ("part", "cut"):
    data = numpy.load(name + ".npz")
    voxels = numpy.rint((data["corner"] - [0.1, -7, 1e3]) / 0.3).astype(int) + data["coordinates"]
    world.append(set(map(tuple, voxels)))
print(len(world[0]), "voxels, the same:", world[0] == world[1])
PY
svdag build a.ply -o a.run -s 0.3 --origin 0.1,-7,1e3 --part 1/2 -q
svdag build a.ply -o b.run -s 0.3 --origin 0.1,-7,1e3 --part 2/2 -q
svdag merge a.run b.run -o merged.svdag -q && cmp a.svdag merged.svdag
svdag plan a.ply -o plan -s 0.3 --origin 0.1,-7,1e3 --shards 2 -q && svdag run plan -q && cmp a.svdag plan/a.svdag
svdag build a.ply -o c.run -s 0.3 --part 2/2 -q
svdag merge a.run c.run -o merged.svdag || echo "exit $?"
svdag build a.ply -o r.svdag -r 64 --origin 0,0,0 || echo "exit $?"
svdag build a.ply -o r.svdag -s 1 --origin 0,0 || echo "exit $?"
svdag build a.ply -o r.svdag -s 1 --origin 0,0,1e13 || echo "exit $?"
