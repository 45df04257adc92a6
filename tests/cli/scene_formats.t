# Scene files: formats, broken files, file names.

## build_assimp
# FBX, COLLADA, 3MF and 3DS give the voxels of the same scene as an OBJ, in the limited child process too.
$ python3 $TESTS/foreign_scenes.py s
$ svdag build s.obj -o s.svdag -r 256 -q
$ for name in s.dae s_z.dae s.fbx s_z.fbx s.3mf s.3ds; do
>   svdag build $name -o a.svdag -r 256 -q && cmp s.svdag a.svdag
>   svdag build $name --sandbox -o a.svdag -r 256 -q && cmp s.svdag a.svdag
>   svdag info $name --parts | grep 'object:\|material:'
> done
|                3  object:floor  (0, 0, 0) .. (8, 4, 5)
|                3  object:copy  (-8, 0, 10) .. (0, 4, 15)
|                6  material:stone  (-8, 0, 0) .. (8, 4, 15)
|                3  object:floor  (0, 0, 0) .. (8, 4, 5)
|                3  object:copy  (-8, 0, 10) .. (0, 4, 15)
|                6  material:stone  (-8, 0, 0) .. (8, 4, 15)
|                3  object:floor  (0, 0, 0) .. (8, 4, 5)
|                3  object:copy  (-8, 0, 10) .. (0, 4, 15)
|                6  material:stone  (-8, 0, 0) .. (8, 4, 15)
|                3  object:floor  (0, 0, 0) .. (8, 4, 5)
|                3  object:copy  (-8, 0, 10) .. (0, 4, 15)
|                6  material:stone  (-8, 0, 0) .. (8, 4, 15)
|                6  object:Object_1  (-8, 0, 0) .. (8, 4, 15)
|                3  object:3DSMesh_0  (0, 0, 0) .. (8, 4, 5)
|                3  object:3DSMesh_1  (-8, 0, 10) .. (0, 4, 15)
$ svdag build s.dae -o one.svdag -r 256 -q --include copy
$ svdag info one.svdag | grep occupied
|   occupied: voxels 0 .. 255, 0 .. 128, 0 .. 159; (-8.01568627, -0.0156862745, 9.98431373) to (0.0156862745, 4.03137255, 15.0039216)
$ svdag build s.fbx -o one.svdag -r 256 --exclude 'material:stone'
! svdag: s.fbx: the scene has no triangles to bake
? 3
$ gzip -k s.dae
$ svdag build s.dae.gz -o a.svdag -r 256 -q && cmp s.svdag a.svdag
$ svdag-verify mesh s.svdag s.3ds | tail -1
| ok: every voxel agrees with the scene
$ for name in s.dae s.fbx s.3mf s.3ds; do
>   head -c 200 $name > short.${name#s.}
>   svdag build short.${name#s.} -o b.svdag -r 64 -q 2>&1 | sed 's/file: .*/file: .../'
> done
| svdag: short.dae: is not a valid COLLADA file: ...
| svdag: short.fbx: is not a valid FBX file: ...
| svdag: short.3mf: is not a valid 3MF file: ...
| svdag: short.3ds: is not a valid 3DS file: ...
# Truncated at any place, or with any byte replaced: triangles or an error, of a child that may have died.
$ python3 - <<'PY'
> import pathlib, random, subprocess
> random.seed(5)
> codes = set()
> for name in ("s.dae", "s.fbx", "s_z.fbx", "s.3mf", "s.3ds"):
>     data = pathlib.Path(name).read_bytes()
>     for i in range(24):
>         at = random.randrange(len(data))
>         hostile = data[:at] if i % 3 == 0 else data[:at] + bytes([random.choice((0, 255, 0x7f, 0x39))]) + data[at + 1:]
>         path = pathlib.Path("hostile." + name.split(".")[1])
>         path.write_bytes(hostile)
>         done = subprocess.run(["svdag", "info", path, "--sandbox"][:3 + i % 2], capture_output=True, text=True)
>         assert done.returncode in (0, 3), (name, i, done)
>         assert done.returncode == 0 or done.stderr.startswith("svdag: hostile."), done
>         codes.add(done.returncode)
> print("exit codes", sorted(codes))
> PY
| exit codes [0, 3]

## build_empty_scene
$ printf 'ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n' > empty.ply
$ svdag build empty.ply -r 64 -o r.svdag
! svdag: empty.ply: the scene has no triangles to bake
? 3

## build_empty_selection
# Bounds without triangles give a valid file without voxels.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -s 1 --bounds=500,500,500,501,501,501 -o r.svdag -q
$ svdag-verify check r.svdag -q
$ svdag info r.svdag --json | grep '"voxels"'
|   "voxels": 0,

## build_foreign_format
# A scene of a format that is not read: the message names the format and a way to convert it.
$ for name in a.blend a.abc a.usd a.usda a.usdc a.usdz a.step cloud.las scene.obj.zst a.vdb; do
>   echo data > $name
>   svdag build $name -r 64 -o r.svdag || echo "exit $?"
> done
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
! svdag: a.blend: is Blender, which svdag does not read: open it in Blender and export it as .glb
! svdag: a.abc: is Alembic, which svdag does not read: open it in Blender and export it as .glb
! svdag: a.usd: is USD, which svdag does not read: svdag-usd bakes it, a program of the Python package with the extra [usd]
! svdag: a.usda: is USD, which svdag does not read: svdag-usd bakes it, a program of the Python package with the extra [usd]
! svdag: a.usdc: is USD, which svdag does not read: svdag-usd bakes it, a program of the Python package with the extra [usd]
! svdag: a.usdz: is USD, which svdag does not read: svdag-usd bakes it, a program of the Python package with the extra [usd]
! svdag: a.step: is a CAD model, which svdag does not read: tessellate it, for example with FreeCAD, and export it as .stl
! svdag: cloud.las: is a point cloud (LAS), which svdag does not read: svdag import takes points; for triangles, reconstruct a surface
! svdag: scene.obj.zst: is compressed with zstd, which svdag does not read: unpack it with unzstd
! svdag: a.vdb: is an OpenVDB grid, which svdag does not read: svdag import reads its voxels
$ printf 'BLENDER-v300' > unnamed
$ svdag build unnamed -r 64 -o r.svdag
! svdag: unnamed: is Blender, which svdag does not read: open it in Blender and export it as .glb
? 3
$ mkdir folder
$ svdag build folder -r 64 -o r.svdag
! svdag: folder: is a folder: name a file in it
? 3
$ svdag build https://example.org/a.glb -r 64 -o r.svdag
! svdag: https://example.org/a.glb: is a URL, which svdag does not read: download the file first
? 3
$ printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' > points.ply
$ svdag build points.ply -r 64 -o r.svdag
! svdag: points.ply: the scene has no triangles to bake; points.ply holds only points, which svdag import takes; for triangles, reconstruct a surface
? 3

## build_gltf_skin
# A skinned mesh is baked as stored, and the summary reports it.
$ printf '%s' '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"skin":0}],
>   "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
>   "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
>   "bufferViews":[{"buffer":0,"byteLength":36}],
>   "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' >puppet.gltf
$ svdag build puppet.gltf -r 64 -o puppet.svdag | tail -n +2
|   1 triangle is read as stored: skins and morph targets are not applied
$ svdag info puppet.gltf
| puppet.gltf: 1 triangle, 3 positions, 1 component
|   bounds (0, 0, 0) .. (1, 1, 0)
|   0 triangles of zero area, 0 of them with two equal corners; 0 repeated triangles
|   3 open edges, 0 non-manifold edges
|   not closed at 64K^3: 3 open edges, the first at (1, 0, 0)
|   1 triangle is read as stored: skins and morph targets are not applied

## build_gzip
# A scene that was compressed with gzip, in every format: same voxels, and nothing is left behind.
$ svdag-scene city -n 6K -q -o city.ply
$ svdag build city.ply -o plain.svdag -r 256 -q
$ gzip -k city.ply
$ svdag build city.ply.gz -o a.svdag -r 256 -m 3M -q && cmp plain.svdag a.svdag
$ mv city.ply.gz noname
$ svdag build noname -o a.svdag -r 256 -q && cmp plain.svdag a.svdag
$ cat > t.obj <<'OBJ'
> v 0 0 0
> v 9 0 1
> v 0 7 2
> f 1 2 3
> OBJ
$ printf 'OFF\n3 1 0\n0 0 0\n9 0 1\n0 7 2\n3 0 1 2\n' > t.off
$ printf 'solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 9 0 1\nvertex 0 7 2\nendloop\nendfacet\nendsolid\n' > t.stl
$ for kind in glb obj ply fbx; do cp t.stl x.$kind; svdag build x.$kind -o x.svdag -r 64 2>&1 || echo "exit $?"; done
| svdag: x.glb: is an STL under the name of another format: rename it to .stl
| exit 3
| svdag: x.obj: is an STL under the name of another format: rename it to .stl
| exit 3
| svdag: x.ply: is an STL under the name of another format: rename it to .stl
| exit 3
| svdag: x.fbx: is an STL under the name of another format: rename it to .stl
| exit 3
$ svdag build t.obj -o t.svdag -r 64 -q
$ for name in t.obj t.off t.stl; do
>   gzip $name
>   svdag build $name.gz -o a.svdag -r 64 --scratch . -q && cmp t.svdag a.svdag
> done
$ svdag info t.obj.gz | head -2
| t.obj.gz: 1 triangle, 3 positions, 1 component
|   bounds (0, 0, 0) .. (9, 7, 2)
$ svdag-verify mesh t.svdag t.off.gz | tail -1
| ok: every voxel agrees with the scene
$ svdag plan t.stl.gz -r 64 -o plan --shards 2 -q
$ svdag run plan -q && cmp t.svdag plan/plan.svdag
$ head -c 20 t.obj.gz > short.obj.gz
$ svdag build short.obj.gz -o b.svdag -r 64
! svdag: short.obj.gz: ends too early (at byte 20)
? 3
$ TMPDIR=/nowhere svdag info t.obj.gz | head -1
| t.obj.gz: 1 triangle, 3 positions, 1 component
$ ls -A
| a.svdag
| city.ply
| noname
| plain.svdag
| plan
| short.obj.gz
| t.obj.gz
| t.off.gz
| t.stl.gz
| t.svdag
| x.fbx
| x.glb
| x.obj
| x.ply

## build_missing_scene
$ svdag build missing.ply -r 64 -o r.svdag
! svdag: missing.ply: cannot be opened: no such file or folder
? 3

## build_not_a_number
# NaN is an error that names the triangle, unless --skip-invalid is given.
$ printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nnan 0 0\n1 1 1\n3 0 1 2\n3 3 4 5\n' > bad.off
$ svdag build bad.off -r 64 -o r.svdag
! svdag: bad.off: triangle 1 has a coordinate that is NaN or infinite (--skip-invalid drops such triangles)
? 3
$ svdag build bad.off -r 64 -o r.svdag --skip-invalid -q

## build_not_utf8
# Names that are not valid UTF-8 do not fail a bake: in JSON the invalid bytes are replaced.
$ latin=$(printf 'caf\351')
$ svdag-scene city -n 3K -q -o good.ply
$ cp good.ply "$latin.ply"
$ printf 'v 0 0 \377\376\nf 1 2 3\n' > bad.obj
$ cat > list.json <<'LIST'
> [{"scene": "bad.obj", "output": "bad.svdag", "resolution": 64},
>  {"scene": "good.ply", "output": "good.svdag", "resolution": 64}]
> LIST
$ svdag batch list.json --keep-going --report batch.json -q 2> /dev/null
? 3
$ grep '"exit"\|"error"\|"bakes"' batch.json
|   "bakes": 2,
|       "exit": 3,
|       "error": "bad.obj: has \"��\" where a number should be (line 1)"
|       "exit": 0,
$ svdag build "$latin.ply" -r 64 -o "$latin.svdag" --report report.json -q
$ grep -A 1 '"scene"\|"name"' report.json
|   "scene": [
|     "caf�.ply"
| --
|       "name": "caf�.ply",
|       "bytes": 63176,
$ svdag info --json "$latin.ply" | grep -A 1 '"scene"'
|   "scene": [
|     "caf�.ply"
$ svdag-verify check --json "$latin.svdag" | grep -o '"file":"[^"]*"'
| "file":"caf�.svdag"
$ svdag-verify diff --json "$latin.svdag" good.svdag | grep -o '"a":"[^"]*"\|"same":[a-z]*'
| "a":"caf�.svdag"
| "same":true
$ svdag-verify mesh --json "$latin.svdag" good.ply | grep -o '"file":"[^"]*"'
| "file":"caf�.svdag"
$ svdag-verify trace --json "$latin.svdag" good.ply --rays 100 | grep -o '"file":"[^"]*"'
| "file":"caf�.svdag"

## build_truncated_scene
# The file ends within the faces; the old output is kept.
$ svdag-scene city -n 120 -q -o city.ply
$ head -c 1000 city.ply > cut.ply
$ echo old > out.svdag
$ svdag build cut.ply -r 64 -o out.svdag
! svdag: cut.ply: promises 80 elements "vertex", more than its bytes can hold (at byte 173)
? 3
$ cat out.svdag
| old

## build_unknown_format
$ echo "hello, this is not a mesh" > notes.txt
$ svdag build notes.txt -r 64 -o r.svdag
! svdag: notes.txt: is not a supported scene file: svdag reads PLY, STL, OBJ, OFF, glTF, GLB, B3DM, I3DM, Draco, OpenMesh, FBX, COLLADA, 3MF and 3DS files, also as .gz; OBJ and binary STL by the ending of their names
? 3

## build_unknown_vectors
# Unknown or unsupported vectors are rejected with a list of the supported ones.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag --vectors MMX
!* svdag: --vectors: "MMX" is not available on this processor: choose one of *, plain
? 2
