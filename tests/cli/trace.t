# svdag-trace.

## trace_bad_option
$ svdag-trace a.svdag --speed 9
! svdag-trace: unknown option --speed of svdag-trace; see svdag-trace --help
? 2

## trace_broken
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 64 -o city.svdag -q
# A pointer of the first node of the deepest inner level.
$ section=$(od -An -tu8 -j 248 -N 8 city.svdag)
$ printf '\377\377\377\177' | dd of=city.svdag bs=1 seek=$((section + 4)) conv=notrunc 2>/dev/null
$ svdag-trace city.svdag
! svdag-trace: city.svdag: damaged file: a child pointer does not lead to a node
? 3

## trace_cpu
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 256 -o city.svdag -q
$ svdag-trace city.svdag --size 48x32 --samples 8 --rounds 1 -j 1 --dump one.bin --picture city.ppm
| CPU, 1 thread
| workload         rays          hit   seconds   MRays/s
|* primary          1536          701 *
|* shadow            701          257 *
|* soft             5608         2069 *
|* ao               5608         1975 *
|* results  ????????????????
$ svdag-trace city.svdag --size 48x32 --samples 8 --rounds 1 -j 2 --no-beams --dump two.bin | grep results
|* results  ????????????????
$ cmp one.bin two.bin
$ wc -c < one.bin
| 86016
$ head -c 15 city.ppm | head -n 2
| P6
| 48 32

## trace_full_disk
# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o a.svdag -q
$ echo old > dump.bin
$ ln dump.bin other.bin
$ svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --picture new.ppm > /dev/null
$ (ulimit -f 8; svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --dump dump.bin > /dev/null)
! svdag-trace: dump.bin: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ cat dump.bin
| old
$ svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --dump dump.bin > /dev/null
$ cat other.bin
| old
$ svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --dump nowhere/dump.bin > /dev/null
! svdag-trace: nowhere: cannot write in this folder: no such file or folder
? 4
$ ls -A
| a.svdag
| dump.bin
| new.ppm
| other.bin
| s.ply

## trace_help
$ svdag-trace --help | head -n 2
| Traces rays through a .svdag on the processor or a GPU, and counts them per
| second.

## trace_json
# The counts of svdag-trace as JSON; hits and hash are those of the table.
$ svdag-scene city -n 6K -q -o city.ply
$ svdag build city.ply -o city.svdag -r 256 -q
$ svdag-trace city.svdag --size 64x48 --samples 4 --rounds 1 -j 1 > table
$ svdag-trace city.svdag --size 64x48 --samples 4 --rounds 1 -j 1 --json > json
$ python3 - <<'CHECK'
> import json
> traced = json.load(open("json"))
> lines = open("table").read().splitlines()
> print(lines[0] == traced["device"], lines[-1].split()[1] == traced["results"])
> for line, work in zip(lines[2:], traced["workloads"]):
>     print(work["workload"], line.split()[:3] == [work["workload"], str(work["rays"]), str(work["hit"])], work["seconds"] > 0)
> CHECK
| True True
| primary True True
| shadow True True
| soft True True
| ao True True

## trace_layers
# Rays know their layer, in both layouts; a layer is traced alone; the judge by rays compares layers.
$ svdag-scene atrium -q -o a.obj
$ for layout in plain compact; do svdag build a.obj -o $layout.svdag -r 128 -q --layers material --layout $layout; done
$ trace() { svdag-trace --preset inside --size 64x36 --samples 2 --rounds 1 "$@"; }
$ layers() { trace --json "$@" | sed 's/.*"layers"://; s/}$//' | tr '{' '\n' | grep -v '"hit":0'; }
$ layers plain.svdag
| [
| "name":"blue cloth","hit":71},
| "name":"floor","hit":492},
| "name":"leaves","hit":75},
| "name":"plaster","hit":83},
| "name":"red cloth","hit":288},
| "name":"roof","hit":11},
| "name":"stone","hit":1072},
| "name":"vase","hit":27}]
$ layers compact.svdag | md5sum | cut -c1-8
| 53784431
$ layers plain.svdag | md5sum | cut -c1-8
| 53784431
$ svdag convert plain.svdag -o cloth.svdag -q --layer "blue cloth"
$ for file in "plain.svdag --layer" "compact.svdag --layer"; do trace $file "blue cloth" | grep -E "primary|results" | cut -c1-34; done
| primary          2304          236
| results  59c3c7ed63c79b39
| primary          2304          236
| results  59c3c7ed63c79b39
$ trace cloth.svdag | grep primary | cut -c1-34
| primary          2304          236
$ trace plain.svdag --layer clot
! svdag-trace: --layer: the file has no layer "clot" (svdag info --layers lists them)
? 2
$ trace cloth.svdag --layer cloth
! svdag-trace: --layer: the file has no layer "cloth" (svdag info --layers lists them)
? 2
$ svdag-verify trace plain.svdag a.obj --rays 20000 | grep -E "layers|ok"
| layers      0 triangle hits are in voxels that are not in their layer, 13,561 judged
| ok: all judged voxels and triangles agree
$ sed 's/usemtl blue cloth/usemtl stone/' a.obj > b.obj
$ svdag-verify trace plain.svdag b.obj --rays 20000 > out
? 1
$ grep -E "layers|ray |ok" out | cut -c1-60 | head -4
| layers      217 triangle hits are in voxels that are not in 
|   layer     ray 103 hits a triangle of layer stone at (-1.14
|   layer     ray 329 hits a triangle of layer stone at (2.572
|   layer     ray 339 hits a triangle of layer stone at (0.532

## trace_no_gpu
$ svdag-scene speck -n 8 -q -o a.ply
$ svdag build a.ply -r 16 -o a.svdag -q
$ svdag-trace a.svdag --device cuda --size 8x8
! svdag-trace: --device cuda: this svdag-trace was built without CUDA: build it with make cuda
? 2

## trace_not_a_file
# A folder or a pipe is rejected without reading it. A file of another kind is not reported as damaged.
$ mkdir folder
$ mkfifo pipe
$ svdag-scene rectangle -q -o r.ply
$ svdag-scene scan -n 1K -q -o scan.ply
$ for name in folder folder/ pipe none.svdag r.ply scan.ply; do
>   svdag-trace $name || echo "exit $?"
> done
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
! svdag-trace: folder: is a folder: name a file in it
! svdag-trace: folder/: is a folder: name a file in it
! svdag-trace: pipe: is not a regular file
! svdag-trace: none.svdag: cannot be opened: no such file or folder
! svdag-trace: r.ply: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene
! svdag-trace: scan.ply: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene

## trace_other_picture
# A picture format that is not supported, and a light of nearly infinite size.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 16 -o a.svdag -q
$ svdag-trace a.svdag --picture a.png
! svdag-trace: a.png: pictures are PPM: choose a name in .ppm (svdag-verify render: PNG)
? 2
$ svdag-trace a.svdag --light 0,0,0,1e308
! svdag-trace: --light: the position must be finite, the radius 0 or more
? 2

## trace_outputs_are_two
# Two outputs must be two files, under any names, even if neither exists.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o a.svdag -q
$ mkdir folder
$ ln -s folder link
$ trace() { svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 "$@" > traced 2>&1 || { echo "exit $?"; cat traced; }; }
$ trace --dump x --picture x
| exit 2
| svdag-trace: x would be written twice: choose another name for one of the results
$ trace --dump x --picture ./x
| exit 2
| svdag-trace: ./x would be written twice: choose another name for one of the results
$ trace --dump "$PWD/x" --picture folder/../x
| exit 2
| svdag-trace: folder/../x would be written twice: choose another name for one of the results
$ trace --dump folder/x --picture link/x
| exit 2
| svdag-trace: link/x would be written twice: choose another name for one of the results
$ ls . folder
| .:
| a.svdag
| folder
| link
| s.ply
| traced
|
| folder:
# Links to one file are replaced: they become two files.
$ touch here
$ ln here there
$ trace --dump here --picture there
$ cmp -s here there
? 1
$ trace --dump folder/x --picture x
$ ls . folder
| .:
| a.svdag
| folder
| here
| link
| s.ply
| there
| traced
| x
|
| folder:
| x

## trace_over_its_input
# The input is never overwritten, under any of its names.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o a.svdag -q
$ ln -s a.svdag soft.svdag
$ ln a.svdag hard.svdag
$ cp a.svdag kept.svdag
$ for name in a.svdag ./a.svdag soft.svdag hard.svdag; do
>   svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --dump $name || echo "exit $?"
>   svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --picture $name || echo "exit $?"
> done
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
! svdag-trace: a.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: a.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: ./a.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: ./a.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: soft.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: soft.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: hard.svdag is also an input, which is never overwritten: choose another output
! svdag-trace: hard.svdag is also an input, which is never overwritten: choose another output
$ cmp a.svdag kept.svdag
$ ls
| a.svdag
| hard.svdag
| kept.svdag
| s.ply
| soft.svdag

## trace_refused_outputs
# Outputs that cannot be written are rejected before tracing, and none of them is written.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o a.svdag -q
$ mkdir folder
$ trace() { svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 "$@" || echo "exit $?"; }
$ trace --dump -
| exit 2
! svdag-trace: -: standard output is not supported: name an output file
$ trace --dump folder
| exit 4
! svdag-trace: folder: is a folder: name a file in it
$ trace --dump nowhere/a.bin
| exit 4
! svdag-trace: nowhere: cannot write in this folder: no such file or folder
$ trace --dump good.bin --picture nowhere/a.ppm
| exit 4
! svdag-trace: nowhere: cannot write in this folder: no such file or folder
$ trace --picture "$(printf '%300s' | tr ' ' a).ppm" 2>&1 | cut -c1-20,300-
| svdag-trace: aaaaaaaaaaaaaaaaaaaaa.ppm: the file name is too long: choose a shorter one
| exit 4
$ ls
| a.svdag
| folder
| s.ply

## trace_too_many_pixels
# More results than fit in half of the memory are rejected before tracing (on a machine of 80 GB there is room).
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 16 -o a.svdag -q
$ if [ "$(getconf _PHYS_PAGES)" -gt 20000000 ]; then
>   echo "svdag-trace: --size: the results of 16384x16384 pixels do not fit in half of the memory: choose fewer" >&2
>   exit 5
> fi
> svdag-trace a.svdag --size 16384x16384 --samples 1 --rounds 1 --dump d.bin
! svdag-trace: --size: the results of 16384x16384 pixels do not fit in half of the memory: choose fewer
? 5

## trace_truncated
$ svdag-scene speck -n 8 -q -o a.ply
$ svdag build a.ply -r 16 -o a.svdag -q
$ head -c 1100 a.svdag > b.svdag
$ svdag-trace b.svdag
! svdag-trace: b.svdag: damaged file: its size differs from the size in its header
? 3

## trace_usual_words
# Options as in other programs; a process limited to one processor has one thread.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o ./-a.svdag -q
$ svdag-trace --size=4x4 --samples 1 --rounds 1 -j2 -- -a.svdag | head -1
| CPU, 2 threads
$ taskset -c "$(taskset -cp $$ | sed 's/.*[ :]\([0-9]*\).*/\1/')" \
>   svdag-trace --size=4x4 --samples 1 --rounds 1 ./-a.svdag | head -1
| CPU, 1 thread
$ svdag-trace ./-a.svdag --sise 9
! svdag-trace: unknown option --sise of svdag-trace; did you mean --size?
? 2
$ svdag-trace ./-a.svdag --samples
! svdag-trace: --samples: the value is missing; see svdag-trace --help
? 2
$ svdag-trace ./-a.svdag --samples 4 --samples 8
! svdag-trace: --samples: is given more than once; see svdag-trace --help
? 2
$ svdag-trace -
! svdag-trace: -: standard input is not supported: name an input file
? 2
