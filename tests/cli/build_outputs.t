# What a bake writes: no input is overwritten, an old file is kept when the bake fails.

## build_full_disk
# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
$ svdag-scene city -n 60K -q -o city.ply
$ echo old > city.svdag
$ ulimit -f 8
$ svdag build city.ply -r 1K -o city.svdag -q
! svdag: city.svdag: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ cat city.svdag
| old
$ ls
| city.ply
| city.svdag

## build_longest_name
# An output may have the longest name that the file system allows; its scratch folder has a shorter one.
$ name=$(printf '%0249d' 0).svdag
$ svdag-scene scan -n 70K -q -o s.ply
$ svdag build s.ply -r 1K -o $name -q -m 8M --checkpoint 0.01
$ svdag build s.ply -r 1K -o s.svdag -q
$ cmp $name s.svdag
$ svdag build s.ply -r 1K -o $name --dry-run -q
$ svdag build s.ply -r 1K -o 0$name -q
! svdag: 0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000.svdag: the file name is too long: choose a shorter one
? 4
$ ls
| 000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000.svdag
| s.ply
| s.svdag

## build_missing_folder
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o missing/r.svdag
! svdag: missing: cannot write in this folder: no such file or folder
? 4

## build_over_its_buffer
# The buffers of a glTF file are inputs too; other files in their folder may be outputs.
$ python3 - <<'PY'
> import json, struct
> open("s.bin", "wb").write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
> json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
>            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
>            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
>            "bufferViews": [{"buffer": 0, "byteLength": 36}],
>            "buffers": [{"uri": "s.bin", "byteLength": 36}]}, open("s.gltf", "w"))
> PY
$ cp s.bin kept.bin
$ svdag build s.gltf -r 16 -o s.bin 2>&1
| svdag: s.bin is also an input, which is never overwritten: choose another output
? 2
$ svdag build s.gltf -r 16 -o s.svdag --report ./s.bin 2>&1
| svdag: ./s.bin is also an input, which is never overwritten: choose another output
? 2
$ echo '[{"scene": "s.gltf", "resolution": 16, "output": "s.svdag"},
>        {"scene": "s.gltf", "resolution": 16, "output": "s.bin"}]' > l.json
$ svdag batch l.json 2>&1
| svdag: l.json: bake 2: s.bin is also an input, which is never overwritten: choose another output
? 2
$ svdag batch l.json --report s.bin 2>&1
| svdag: l.json: bake 2: s.bin is also an input, which is never overwritten: choose another output
? 2
$ cmp s.bin kept.bin
$ svdag build s.gltf -r 16 -o s.svdag -q
$ svdag build s.gltf -r 16 -o s.svdag -q
$ cmp s.bin kept.bin
$ ls
| kept.bin
| l.json
| s.bin
| s.gltf
| s.svdag

## build_over_its_input
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o ./r.ply
! svdag: ./r.ply is also an input, which is never overwritten: choose another output
? 2

## build_over_other_names
# No output overwrites an input or another output, under any name of the file.
$ svdag-scene rectangle -q -o h.ply
$ svdag-scene rectangle -q -o h2.ply
$ cp h2.ply kept.ply
$ mkdir sub
$ refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
$ list() { echo "[$1]" > l.json; cp l.json l.kept; refused svdag batch l.json $2; cmp l.json l.kept; }
$ A='"scene": "h.ply", "resolution": 64, "output": "a.svdag"'
$ refused svdag build h.ply -r 64 -o x.svdag --report ./x.svdag
| svdag: ./x.svdag would be written twice: choose another name for one of the results
| exit 2
$ refused svdag build h.ply -r 64 -o x.svdag --report sub/../h.ply
| svdag: sub/../h.ply is also an input, which is never overwritten: choose another output
| exit 2
$ refused svdag build h.ply -r 64 -o ''
| svdag: -o: the value is empty; see svdag build --help
| exit 2
$ list "{$A}" '--report l.json'
| svdag: l.json is also an input, which is never overwritten: choose another output
| exit 2
$ list "{$A}" '--report ./a.svdag'
| svdag: ./a.svdag would be written twice: choose another name for one of the results
| exit 2
$ list "{$A}, {\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"./a.svdag\"}"
| svdag: l.json: bake 2: ./a.svdag would be written twice: choose another name for one of the results
| exit 2
$ list "{\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"h2.ply\"}, {\"scene\": \"h2.ply\", \"resolution\": 64, \"output\": \"b.svdag\"}"
| svdag: l.json: bake 1: h2.ply is also an input, which is never overwritten: choose another output
| exit 2
$ list "{$A, \"report\": \"r.json\"}, {\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"b.svdag\", \"report\": \"./r.json\"}"
| svdag: l.json: bake 2: ./r.json would be written twice: choose another name for one of the results
| exit 2
$ list "{$A, \"report\": \"l.json\"}"
| svdag: l.json: bake 1: l.json is also an input, which is never overwritten: choose another output
| exit 2
$ list '{"scene": "h.ply", "resolution": 64, "output": ""}'
| svdag: l.json: bake 1: --output: the value is empty; see svdag build --help
| exit 2
$ cmp h.ply h2.ply
$ cmp h2.ply kept.ply
# Existing outputs may be hard links to each other: each name gets its own file. A symbolic link is another name.
$ svdag build h.ply -r 64 -o one.svdag -q
$ cp one.svdag a.svdag
$ ln a.svdag b.svdag
$ ln -s a.svdag c.svdag
$ echo "[{$A}, {\"scene\": \"h.ply\", \"resolution\": 32, \"output\": \"b.svdag\"}]" > links.json
$ svdag batch links.json -q
$ cmp one.svdag a.svdag
$ stat -c '%n %h %F' a.svdag b.svdag
| a.svdag 1 regular file
| b.svdag 1 regular file
$ list "{$A}, {\"scene\": \"h.ply\", \"resolution\": 16, \"output\": \"c.svdag\"}"
| svdag: l.json: bake 2: c.svdag would be written twice: choose another name for one of the results
| exit 2
$ ls
| a.svdag
| b.svdag
| c.svdag
| h.ply
| h2.ply
| kept.ply
| l.json
| l.kept
| links.json
| one.svdag
| sub

## no_clobber
# -n: an existing output is kept, and a batch skips it.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag build s.ply -r 64 -o a.svdag -q -n
$ cp a.svdag kept.svdag
$ svdag build s.ply -r 32 -o a.svdag -q -n
! svdag: a.svdag: already exists: choose another name, or omit --no-clobber
? 2
$ svdag export a.svdag -o kept.svdag --format symvox -n
! svdag: kept.svdag: already exists: choose another name, or omit --no-clobber
? 2
$ svdag export a.svdag -o a.npz -q --no-clobber
$ svdag import a.npz -o a.svdag -n
! svdag: a.svdag: already exists: choose another name, or omit --no-clobber
? 2
$ cmp a.svdag kept.svdag
$ echo '[{"scene": "s.ply", "output": "a.svdag"}, {"scene": "s.ply", "output": "b.svdag"}]' > list.json
$ svdag batch list.json -r 32 -n | tail -3 | sed "s|, [0-9.]* s$||"
| a.svdag: already exists, skipped
| b.svdag: 32^3, 100 triangles, 3 voxels, 10 nodes, 1.6 KiB (4.46e+03 bits per voxel)
| 1 of 2 baked, 0 failed, 1 skipped
$ cmp a.svdag kept.svdag

## outputs_closed_pipe
# A closed pipe ends the program by SIGPIPE, and its files are complete.
$ svdag-scene city -n 3K -q -o a.ply
$ closed() { { sleep 0.1; "$@" || echo "$1 $2: exit $?" >&2; } | true; }
$ closed svdag build a.ply -r 64 -o a.svdag
! svdag build: exit 141
$ closed svdag info a.svdag
! svdag info: exit 141
$ closed svdag-verify check a.svdag
! svdag-verify check: exit 141
$ closed svdag export a.svdag -o a.vdb
! svdag export: exit 141
$ svdag-verify vdb a.svdag a.vdb -q
$ ls
| a.ply
| a.svdag
| a.vdb

## outputs_no_files
# An output that is a folder, a pipe or a device, or a link to one, is rejected before the work begins,
# and is not changed.
$ refused() { "$@" || echo "exit code $?"; }
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q --report r.json
$ svdag build r.ply -r 64 -o r.run -q --part 1/1
$ svdag export r.svdag -o r.npz -q
$ mkdir folder.svdag
$ mkfifo pipe.svdag pipe.npz pipe.png
$ ln -s /dev/null device.svdag
$ ln -s /proc/self/fd/1 stdout.svdag
$ for out in folder pipe device stdout; do refused svdag build r.ply -r 64 -o $out.svdag; done
| exit code 4
| exit code 4
| exit code 4
| exit code 4
! svdag: folder.svdag: is a folder: name a file in it
! svdag: pipe.svdag: is not a regular file and cannot be replaced: choose another name
! svdag: device.svdag: is not a regular file and cannot be replaced: choose another name
! svdag: stdout.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag build r.ply -r 64 -o new.svdag --report pipe.svdag
| exit code 4
! svdag: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag build r.ply -r 64 -o new.svdag --report nowhere/r.json
| exit code 4
! svdag: nowhere: cannot write in this folder: no such file or folder
$ echo '[{"scene": "r.ply", "output": "new.svdag", "resolution": 64}]' >list.json
$ refused svdag batch list.json --report device.svdag
| exit code 4
! svdag: device.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag build r.ply -r 64 -o pipe.svdag --dry-run
| exit code 4
! svdag: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag merge r.run -o pipe.svdag
| exit code 4
! svdag: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag export r.svdag -o pipe.npz
| exit code 4
! svdag: pipe.npz: is not a regular file and cannot be replaced: choose another name
$ refused svdag import r.npz -o pipe.svdag
| exit code 4
! svdag: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag-verify report r.svdag r.json -o pipe.svdag
| exit code 4
! svdag-verify: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ refused svdag-verify render r.svdag -o pipe.png
| exit code 4
! svdag-verify: pipe.png: is not a regular file and cannot be replaced: choose another name
$ refused svdag-verify diff r.svdag r.svdag --write-diff pipe.svdag
| exit code 4
! svdag-verify: pipe.svdag: is not a regular file and cannot be replaced: choose another name
$ ls -F
| device.svdag@
| folder.svdag/
| list.json
| pipe.npz|
| pipe.png|
| pipe.svdag|
| r.json
| r.npz
| r.ply
| r.run
| r.svdag
| stdout.svdag@
# The output goes where a symbolic link points, to a file or to a new name; the link is kept.
$ echo old >file
$ ln -s file link.svdag
$ ln -s new dangling.svdag
$ svdag build r.ply -r 64 -o link.svdag -q
$ svdag build r.ply -r 64 -o dangling.svdag -q
$ cmp file r.svdag && cmp new r.svdag
$ cmp link.svdag r.svdag && cmp dangling.svdag r.svdag
$ ls -F
| dangling.svdag@
| device.svdag@
| file
| folder.svdag/
| link.svdag@
| list.json
| new
| pipe.npz|
| pipe.png|
| pipe.svdag|
| r.json
| r.npz
| r.ply
| r.run
| r.svdag
| stdout.svdag@
