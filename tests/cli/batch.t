# svdag batch: lists of bakes.

## build_batch
# Two good bakes; then a list with a bake that fails between them, with and without --keep-going.
$ svdag-scene sheet -q -o a.ply
$ svdag-scene city -n 6K -q -o b.ply
$ cat > good.json <<'LIST'
> [{"scene": "a.ply", "output": "a.svdag", "resolution": 256, "quiet": true},
>  {"scene": ["a.ply", "b.ply"], "output": "ab.svdag", "voxel-size": 4, "rule": "thin"}]
> LIST
$ svdag batch good.json -q -j 1 --report all.json
$ svdag build b.ply a.ply -o one.svdag -s 4 --rule thin -q
$ cmp ab.svdag one.svdag
$ python3 -c 'import json; r = json.load(open("all.json")); print(r["bakes"], [(d["output"], d["exit"], d["report"]["threads"]) for d in r["done"]])'
| 2 [('a.svdag', 0, 1), ('ab.svdag', 0, 1)]
$ cat > bad.json <<'LIST'
> [{"scene": "missing.ply", "output": "m.svdag", "resolution": "1K"},
>  {"scene": "a.ply", "output": "a2.svdag", "resolution": "256"}]
> LIST
$ svdag batch bad.json 2>&1
| svdag: bad.json: bake 1: missing.ply: cannot be opened: no such file or folder
? 3
$ svdag batch bad.json --keep-going --report bad_report.json -q 2>&1
| svdag: m.svdag: missing.ply: cannot be opened: no such file or folder
? 3
$ cmp a.svdag a2.svdag
$ echo '[{"scene": "a.ply", "output": "x.svdag"}]' > incomplete.json
$ svdag batch incomplete.json 2>&1
| svdag: incomplete.json: bake 1: give one of --resolution or --voxel-size; see svdag build --help
? 2
$ echo '[{"scene": "a.ply", "output": "x.svdag", "resolution": 64}, {"scene": "b.ply", "output": "x.svdag", "resolution": 64}]' > twice.json
$ svdag batch twice.json 2>&1
| svdag: twice.json: bake 2: x.svdag would be written twice: choose another name for one of the results
? 2
$ echo '{"scene": 7' > broken.json
$ svdag batch broken.json 2>&1
| svdag: broken.json: is not valid JSON (at byte 13)
? 3
$ ls
| a.ply
| a.svdag
| a2.svdag
| ab.svdag
| all.json
| b.ply
| bad.json
| bad_report.json
| broken.json
| good.json
| incomplete.json
| one.svdag
| twice.json

## build_batch_defaults
# Options of the command line are defaults of every bake.
$ svdag-scene city -n 3K -q -o a.ply
$ echo '[{"scene": "a.ply", "output": "thin.svdag"},
>        {"scene": "a.ply", "output": "said.svdag", "voxel-size": 4, "rule": "conservative"},
>        {"scene": "a.ply", "output": "half.run", "part": "1/2", "quiet": false},
>        {"scene": "a.ply", "output": "quiet.svdag", "quiet": true}]' > list.json
$ svdag batch list.json -r 64 --rule thin --bounds=0,0,0,100,100,100 -j 1 --checkpoint 5 | sed 's/:.*//'
| thin.svdag
| said.svdag
| half.run
| 4 of 4 baked, 0 failed
$ svdag build a.ply -r 64 --rule thin --bounds=0,0,0,100,100,100 -o t.svdag -q
$ svdag build a.ply -s 4 --bounds=0,0,0,100,100,100 -o s.svdag -q
$ cmp t.svdag thin.svdag
$ cmp t.svdag quiet.svdag
$ cmp s.svdag said.svdag
$ echo '[{"scene": ["a.ply", "a.ply"], "output": "all.svdag", "exclude": ["a.*", "b.*"]},
>        {"scene": "a.ply", "output": "none.svdag"}]' > names.json
$ svdag batch names.json -r 64 --include '*.ply' --exclude 'a*' --keep-going 2>&1
| svdag: all.svdag: --exclude 'b.*' matches nothing: the nearest names are file:a.ply (--allow-empty goes on)
| svdag: none.svdag: a.ply: the scene has no triangles to bake
| 0 of 2 baked, 2 failed
? 2
$ for wrong in a.ply '-o x.svdag' '--part 1/2' '-r 64 -s 1'; do
>   svdag batch list.json $wrong 2>&1 || echo "exit $?"
> done
| svdag: unexpected argument: a.ply; see svdag batch --help
| exit 2
| svdag: unknown option -o of svdag batch; see svdag batch --help
| exit 2
| svdag: unknown option --part of svdag batch; see svdag batch --help
| exit 2
| svdag: give only one of --resolution or --voxel-size; see svdag batch --help
| exit 2
$ for wrong in '"help": true' '"r": 64' '"json": true' '"report": "-"' '"keep-going": true'; do
>   echo '[{"scene": "a.ply", "output": "x.svdag", "resolution": 64, '"$wrong"'}]' > wrong.json
>   svdag batch wrong.json 2>&1 || echo "exit $?"
> done
| svdag: wrong.json: bake 1: help, dry-run and json are not options of one bake in a list: give them to svdag batch
| exit 2
| svdag: wrong.json: bake 1: "r": use the long name of the option
| exit 2
| svdag: wrong.json: bake 1: help, dry-run and json are not options of one bake in a list: give them to svdag batch
| exit 2
| svdag: wrong.json: bake 1: help, dry-run and json are not options of one bake in a list: give them to svdag batch
| exit 2
| svdag: wrong.json: bake 1: unknown option --keep-going of svdag build; see svdag build --help
| exit 2
$ echo '[{"scene": "a.ply", "output": "x.svdag", "skip-invalid": false}]' > wrong.json
$ svdag batch wrong.json -r 64 --skip-invalid 2>&1
| svdag: wrong.json: bake 1: "skip-invalid": false cannot switch off the --skip-invalid of the command line: leave one of them out
? 2
$ echo '[{"scene": "a.ply", "output": "small.svdag", "cache-size": "1M"}]' > small.json
$ svdag batch small.json -r 64 --cache cells -q
$ svdag batch small.json -r 64 -q 2>&1
| svdag: small.json: bake 1: --cache-size requires --cache; see svdag build --help
? 2
$ ls
| a.ply
| cells
| half.run
| list.json
| names.json
| quiet.svdag
| s.svdag
| said.svdag
| small.json
| small.svdag
| t.svdag
| thin.svdag
| wrong.json

## build_batch_dry_run
# --dry-run predicts every bake and writes nothing; it applies to the whole list.
$ svdag-scene sheet -q -o a.ply
$ svdag build a.ply -r 64 -o old.svdag -q
$ cp old.svdag kept.svdag
$ echo '[{"scene": "a.ply", "output": "old.svdag", "resolution": 128},
>        {"scene": "a.ply", "output": "new.svdag", "resolution": 256}]' > list.json
$ svdag batch list.json --dry-run -j 1 -m 200M
|* old.svdag: 128^3, 2 triangles in * cells
|*   about * CPU seconds, * s on 1 thread
|*   a file of about * *, scratch of about 0 bytes
|*   memory of about * *, at most * * with --memory *M
|* new.svdag: 256^3, 2 triangles in * cells
|*   about * CPU seconds, * s on 1 thread
|*   a file of about * *, scratch of about 0 bytes
|*   memory of about * *, at most * * with --memory *M
| 2 of 2 predicted, 0 failed
|*   in all about * CPU seconds, * s; files of about * *, scratch of at most 0 bytes and memory of at most * * at once
$ cmp old.svdag kept.svdag
$ svdag batch list.json --dry-run --report r.json 2>&1
| svdag: --dry-run cannot be combined with --report; see svdag batch --help
? 2
$ echo '[{"scene": "a.ply", "output": "old.svdag", "resolution": 128, "dry-run": true}]' > one.json
$ svdag batch one.json 2>&1
| svdag: one.json: bake 1: help, dry-run and json are not options of one bake in a list: give them to svdag batch
? 2
$ cmp old.svdag kept.svdag
$ ls
| a.ply
| kept.svdag
| list.json
| old.svdag
| one.json

## build_batch_parallel
# Bakes of a list that run at once write the same files and the same report, in the order of the list.
$ svdag-scene city -n 6K -q -o a.ply
$ svdag-scene sheet -q -o b.ply
$ cat > list.json <<'LIST'
> [{"scene": "a.ply", "output": "a.svdag", "resolution": "512"},
>  {"scene": "b.ply", "output": "b.svdag", "resolution": "64"},
>  {"scene": "a.ply", "output": "thin.svdag", "resolution": "256", "rule": "thin", "memory": "1G"}]
> LIST
$ done_in() { python3 -c 'import json, sys; r = json.load(sys.stdin); print([(d["output"], d["exit"], d["report"]["memory"]["peak_counted"] <= 1 << 28) for d in r["done"]])'; }
$ svdag batch list.json -P 3 -m 768M --json | done_in
| [('a.svdag', 0, True), ('b.svdag', 0, True), ('thin.svdag', 0, True)]
$ mkdir at_once
$ mv *.svdag at_once
$ svdag batch list.json -q --report - | done_in
| [('a.svdag', 0, True), ('b.svdag', 0, True), ('thin.svdag', 0, True)]
$ for file in *.svdag; do cmp $file at_once/$file; done
# A failure ends the list; bakes that have begun are finished.
$ echo '[{"scene": "a.ply", "output": "c.svdag", "resolution": "64"}, {"scene": "b.ply", "output": "d/d.svdag", "resolution": "64"}]' > bad.json
$ { svdag batch bad.json -P 2 2>&1 || echo "exit $?"; } | sed "s|, [0-9.]* s\$||"
| svdag: d/d.svdag: d: cannot write in this folder: no such file or folder
| c.svdag: 64^3, 6,000 triangles, 15,996 voxels, 547 nodes, 7.8 KiB (4.01 bits per voxel)
| 1 of 2 baked, 1 failed
| exit 4
$ ls *.svdag
| a.svdag
| b.svdag
| c.svdag
| thin.svdag
# They may share a cache.
$ svdag batch list.json -P 3 -q --cache cells
$ for file in at_once/*.svdag; do cmp $file ${file#at_once/}; done
$ svdag batch list.json -q --cache cells --json | python3 -c 'import json, sys; r = json.load(sys.stdin); print(all(d["report"]["cache_hits"] == d["report"]["cells"] for d in r["done"]))'
| True

## build_batch_stopped
# The report of an interrupted batch contains the finished bakes.
$ svdag-scene scan -n 70K -q -o s.ply
$ echo '[{"scene": "s.ply", "output": "a.svdag", "resolution": "64"},
>        {"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M"}]' > l.json
$ env --default-signal=INT svdag batch l.json --report r.json -q &  # background jobs of a shell ignore SIGINT
$ until ls z.svdag.scratch/journal >/dev/null 2>&1; do sleep 0.02; done
$ sleep 0.1
$ kill -s INT $! && wait $!
! svdag: stopped; to continue: svdag batch --resume l.json --report r.json -q
? 130
$ /usr/bin/python3 -c "
> import json
> report = json.load(open('r.json'))
> print(report['bakes'], [(each['output'], each['exit'], len(each['report']['content_hash'])) for each in report['done']])"
| 2 [('a.svdag', 0, 32)]

## build_batch_up_to_date
# With the report of an earlier run, bakes are skipped whose inputs, options and output are unchanged.
$ svdag-scene sheet -q -o a.ply
$ svdag-scene city -n 6K -q -o b.ply
$ list() { echo '[{"scene": "a.ply", "output": "a.svdag", "resolution": "64"}, {"scene": "b.ply", "output": "b.svdag", "resolution": "'"$1"'"}]' > list.json; }
$ bake() { svdag batch list.json --report r.json "$@" | sed 's/: .*s$/: baked/' && cp r.json last.json; }
$ list 64
$ bake
| a.svdag: baked
| b.svdag: baked
| 2 of 2 baked, 0 failed
$ echo "the same again"
| the same again
$ bake
| a.svdag: up to date
| b.svdag: up to date
| 0 of 2 baked, 0 failed, 2 up to date
$ bake -q
$ python3 -c 'import json; print([(d["output"], d["exit"], d.get("up_to_date"), d["report"]["voxels"] > 0) for d in json.load(open("r.json"))["done"]])'
| [('a.svdag', 0, True, True), ('b.svdag', 0, True, True)]
$ echo "another resolution"
| another resolution
$ list 128
$ bake
| a.svdag: up to date
| b.svdag: baked
| 1 of 2 baked, 0 failed, 1 up to date
$ echo "an input of the same name and another content"
| an input of the same name and another content
$ svdag-scene scan -n 2K -q -o a.ply
$ bake
| b.svdag: up to date
| a.svdag: baked
| 1 of 2 baked, 0 failed, 1 up to date
$ echo "a copy of the input, with another time"
| a copy of the input, with another time
$ cp a.ply c.ply && mv c.ply a.ply
$ bake
| a.svdag: up to date
| b.svdag: up to date
| 0 of 2 baked, 0 failed, 2 up to date
$ echo "another output of that name"
| another output of that name
$ svdag build a.ply -o b.svdag -r 64 -q
$ bake
| a.svdag: up to date
| b.svdag: baked
| 1 of 2 baked, 0 failed, 1 up to date
$ echo "a missing output, and a truncated one"
| a missing output, and a truncated one
$ rm a.svdag
$ truncate -s -8 b.svdag
$ bake
| a.svdag: baked
| b.svdag: baked
| 2 of 2 baked, 0 failed
$ echo "no report, and a file that is not one"
| no report, and a file that is not one
$ rm r.json
$ bake
| a.svdag: baked
| b.svdag: baked
| 2 of 2 baked, 0 failed
$ echo '{"done": [{"output": "a.svdag"}]}' > r.json
$ bake
| a.svdag: baked
| b.svdag: baked
| 2 of 2 baked, 0 failed
$ echo "damaged reports"
| damaged reports
$ for text in '' '[' '[]' '7' '{"done": 7}' '{"done": [[]]}' '{"done": [{"exit": 0, "output": 7, "report": {}}]}' \
>   '{"done": [{"exit": 0, "output": "a.svdag", "report": {"description_hash": 1, "content_hash": []}}]}'; do
>   echo "$text" > r.json
>   bake -q
> done
$ head -c 900 last.json > r.json
$ bake -q
$ python3 -c 'print("{\"done\": " + 100000 * "[")' > r.json
$ bake
| a.svdag: baked
| b.svdag: baked
| 2 of 2 baked, 0 failed
$ bake
| a.svdag: up to date
| b.svdag: up to date
| 0 of 2 baked, 0 failed, 2 up to date
