# What a bake reports: --report, --json, --verbose.

## build_json
# --json prints the report instead of the summary; with --dry-run, the prediction.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag build s.ply -r 64 -o a.svdag --json --report r.json > out.json
$ cmp out.json r.json
$ svdag build s.ply -r 64 -o b.svdag --json --dry-run | python3 -c 'import json, sys; print(sorted(json.load(sys.stdin)))'
| ['budget_bytes', 'cells', 'cpu_seconds', 'expected_memory_bytes', 'memory_bytes', 'output_bytes', 'output_free_bytes', 'resolution', 'scratch_bytes', 'scratch_free_bytes', 'seconds', 'threads', 'triangles']
$ svdag build s.ply -r 64 --dry-run -q && ls | grep dry  # without an output
? 1
$ svdag build s.ply -r 64 -q
! svdag: --output is required; see svdag build --help
? 2
$ svdag build s.ply -r 64 -q -o ''
! svdag: -o: the value is empty; see svdag build --help
? 2
$ ls | grep dry
? 1
$ svdag batch list.json --dry-run --json
! svdag: --dry-run cannot be combined with --json; see svdag batch --help
? 2
$ ls
| a.svdag
| out.json
| r.json
| s.ply

## build_report
# The report is JSON with the numbers of the bake.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag --report r.json -q
$ python3 -c '
> import json
> report = json.load(open("r.json"))
> print(report["triangles"], report["grid"]["resolution"], report["nodes"], report["voxels"])
> print(sorted(report["seconds"]), sorted(report["memory"]))
> import os
> print([(f["name"], f["bytes"] == os.path.getsize("r.ply"), len(f["hash"])) for f in report["files"]])
> print(list(report["memory"]["phases"]), max(report["memory"]["phases"].values()) == report["memory"]["peak_counted"])
> print(report["cell_level"])'
| 2 64 [1, 4, 22, 90, 151] 4984
| ['bounds', 'cpu', 'merge', 'sort', 'split', 'total', 'voxelize', 'write'] ['peak_counted', 'peak_resident', 'phases']
| [('r.ply', True, 32)]
| ['bounds', 'split', 'voxelize', 'sort', 'merge', 'write'] True
| 0

## build_report_files
# The report names every file of the scene, buffers of glTF included, by size and XXH3-128.
$ python3 - <<'SCENE'
> import json, struct
> open("corners.bin", "wb").write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
> json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
>            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
>            "buffers": [{"uri": "corners.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
>            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
>                           "min": [0, 0, 0], "max": [1, 1, 0]}]}, open("triangle.gltf", "w"))
> SCENE
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply triangle.gltf -r 64 -o a.svdag --report a.json -q
$ /usr/bin/python3 - <<'PROOF'
> import json, os, xxhash
> for file in json.load(open("a.json"))["files"]:
>     content = open(file["name"], "rb").read()
>     print(file["name"], file["bytes"] == len(content), file["hash"] == xxhash.xxh3_128_hexdigest(content))
> PROOF
| r.ply True True
| triangle.gltf True True
| corners.bin True True

## build_verbose
# -v prints what each phase did.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -v
|* r.svdag: 64^3, 2 triangles, 4,984 voxels, 268 nodes, * s
|*   triangles: *
|*   accuracy: *
|*   * cells visited
|*   planes: * cubes looked up in the memo, * answered; * nodes computed for it
|*   seconds: *
|*   memory: *
