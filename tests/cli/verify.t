# svdag-verify: help, reports, check.

## verify_check_broken
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ printf 'X' | dd of=r.svdag bs=1 seek=1100 conv=notrunc 2>/dev/null
$ svdag-verify check r.svdag
! svdag-verify: r.svdag: damaged file: a block does not match its checksum (at byte 1024)
? 3

## verify_check_truncated
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ head -c 1500 r.svdag > cut.svdag
$ svdag-verify check cut.svdag
! svdag-verify: cut.svdag: damaged file: its size differs from the size in its header (at byte 168)
? 3

## verify_help
$ for subject in check mesh diff vdb trace render report; do
>   svdag-verify help $subject >of_help
>   svdag-verify $subject --help >of_option
>   cmp of_help of_option && head -n 1 of_help
> done
| Prove every checksum and pointer, order and minimality
| Voxelize the scene again, by other means, and compare every voxel
| Count and list the voxels that only one DAG has
| Compare every voxel with an OpenVDB grid
| Send rays through the DAG and through the triangles (by Embree), and compare
| Make a picture by tracing rays through the DAG
| Make an HTML page about a .svdag: pictures, verdicts, levels, times
$ svdag-verify help mehs 2>&1
| svdag-verify: unknown command "mehs" of svdag-verify; did you mean mesh?
? 2
$ svdag biuld --help 2>&1
| svdag: unknown command "biuld" of svdag; did you mean build?
? 2

## verify_not_a_dag
$ svdag-scene rectangle -q -o r.ply
$ svdag-verify check r.ply
! svdag-verify: r.ply: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene
? 3

## verify_report
$ svdag-scene sheet -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q --report a.json
$ svdag-verify report a.svdag a.json -o a.html --size 64x36
| a.html: sound
$ python3 - <<'PAGE'
> import base64, json, re
> page = open("a.html").read()
> pictures = [base64.b64decode(p, validate=True) for p in re.findall(r'src="data:image/png;base64,([^"]+)"', page)]
> print(len(pictures), all(p.startswith(b"\x89PNG") for p in pictures))
> print("loads nothing:", not re.search(r'(src|href)="(?!data:)|@import|url\(', page))
> print("hash:", json.load(open("a.json"))["content_hash"] in page)
> PAGE
| 4 True
| loads nothing: True
| hash: True
$ svdag build a.ply -r 32 -o b.svdag -q --report b.json
$ svdag-verify report a.svdag b.json -o x.html 2>&1
| svdag-verify: b.json: is the report of another bake than a.svdag: their content hashes differ
? 2
$ echo '{"content_hash": 3}' > c.json
$ svdag-verify report a.svdag c.json -o x.html 2>&1
| svdag-verify: c.json: is the report of another bake than a.svdag: their content hashes differ
? 2
$ echo 'no JSON' > c.json
$ svdag-verify report a.svdag c.json -o x.html 2>&1
| svdag-verify: c.json: is neither a report of svdag build nor a verdict of svdag-verify
? 3
$ sed 's/"triangles_invalid": *[0-9]*/"triangles_invalid": 1e24/' a.json >c.json
$ svdag-verify report a.svdag c.json -o x.html 2>&1
| svdag-verify: c.json: a number is not an integer or is out of range
? 3
$ sed 's/"cell_level": *[0-9]*/"cell_level": 40/' a.json >c.json
$ svdag-verify report a.svdag c.json -o x.html 2>&1
| svdag-verify: c.json: has a "cell_level" below the finest level
? 3
$ tr -d ' \n' < a.json | sed 's/"cubes_divided":\[[0-9]*/"cubes_divided":[1e24/' >c.json
$ svdag-verify report a.svdag c.json -o x.html 2>&1
| svdag-verify: c.json: a number is not an integer or is out of range
? 3
$ svdag-verify report a.svdag a.json -o a.json 2>&1
| svdag-verify: a.json is also an input, which is never overwritten: choose another output
? 2
# Verdicts are shown beside the report, which may be left out; each must be about this file.
$ svdag-verify mesh a.svdag a.ply --json > mesh.json
$ svdag-verify check a.svdag --json > check.json
$ svdag-verify report a.svdag mesh.json a.json check.json -o all.html --size 64x36
| all.html: sound
$ grep -o "<p class=\"verdict good\"><b>svdag-verify [a-z]*</b>: ok; [a-z ]*" all.html
| <p class="verdict good"><b>svdag-verify mesh</b>: ok; the integer judge
$ svdag-verify report a.svdag -o bare.html --size 64x36
| bare.html: sound
$ grep -c "Seconds per phase" all.html bare.html
| all.html:1
| bare.html:0
$ svdag-scene city -n 6K -q -o city.ply
$ svdag-verify mesh a.svdag city.ply --sample 100 --json > wrong.json
? 1
$ svdag-verify report a.svdag wrong.json -o wrong.html --size 64x36
| wrong.html: sound, but a verdict is not ok
? 1
$ svdag-verify mesh b.svdag a.ply --json > other.json
$ svdag-verify report a.svdag other.json -o x.html 2>&1
| svdag-verify: other.json: is the report of another bake than a.svdag: their content hashes differ
? 2
$ svdag-verify report a.svdag a.json a.json -o x.html 2>&1
| svdag-verify: a.json: is a second report of the bake: give one
? 2
$ sed 's/"mesh"/"bless"/' mesh.json > unknown.json
$ svdag-verify report a.svdag unknown.json -o x.html 2>&1
| svdag-verify: unknown.json: is a verdict of an unknown command
? 3
$ cut -c 1-100 mesh.json > cut.json
$ svdag-verify report a.svdag cut.json -o x.html 2>&1
| svdag-verify: cut.json: is neither a report of svdag build nor a verdict of svdag-verify
? 3

## verify_too_many
# Numbers of rays and draws that would take too long are rejected; draws are counted as memory.
$ printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\n' > a.obj
$ svdag build a.obj -r 64 -o a.svdag -q
$ for count in 18446744073709551615 1025G; do
>   svdag-verify trace a.svdag a.obj --rays $count || echo "exit $?"
>   svdag-verify mesh a.svdag a.obj --sample $count || echo "exit $?"
>   svdag-verify mesh a.svdag a.obj --sample $count --judge openvdb || echo "exit $?"
> done
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
! svdag-verify: --rays: give at most 1,099,511,627,776
! svdag-verify: --sample: give at most 1,099,511,627,776
! svdag-verify: --sample: give at most 1,099,511,627,776
! svdag-verify: --rays: give at most 1,099,511,627,776
! svdag-verify: --sample: give at most 1,099,511,627,776
! svdag-verify: --sample: give at most 1,099,511,627,776
$ svdag-verify mesh a.svdag a.obj --sample 1T -m 64M
!* svdag-verify: the drawn bricks need * MiB in total, but the memory budget is 64 MiB: raise --memory
? 5
$ svdag-verify mesh a.svdag a.obj --sample 1T -m 64M --judge openvdb
!* svdag-verify: the drawn windows need * MiB in total, but the memory budget is 64 MiB: raise --memory
? 5

## verify_write_over_its_input
# Inputs are never overwritten, under any of their names; this is reported before the comparison.
$ svdag-scene speck -n 8 -q -o s.ply
$ svdag build s.ply -r 16 -o a.svdag -q
$ cp a.svdag b.svdag
$ svdag export a.svdag -o a.vdb -q
$ ln -s b.svdag soft.svdag
$ ln b.svdag hard.svdag
$ cp b.svdag kept.svdag
$ for name in a.svdag b.svdag ./b.svdag soft.svdag hard.svdag; do
>   svdag-verify diff a.svdag b.svdag -q --write-diff $name || echo "exit $?"
> done
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
! svdag-verify: a.svdag is also an input, which is never overwritten: choose another output
! svdag-verify: b.svdag is also an input, which is never overwritten: choose another output
! svdag-verify: ./b.svdag is also an input, which is never overwritten: choose another output
! svdag-verify: soft.svdag is also an input, which is never overwritten: choose another output
! svdag-verify: hard.svdag is also an input, which is never overwritten: choose another output
$ svdag-verify vdb a.svdag a.vdb -q --write-diff ./a.vdb
! svdag-verify: ./a.vdb is also an input, which is never overwritten: choose another output
? 2
$ cp a.svdag fly_0002.png  # a frame is an output, too
$ svdag-verify render fly_0002.png -o fly.png --fly 2 -q
! svdag-verify: fly_0002.png is also an input, which is never overwritten: choose another output
? 2
$ cmp fly_0002.png kept.svdag
$ cmp a.svdag kept.svdag
$ cmp b.svdag kept.svdag
$ ls
| a.svdag
| a.vdb
| b.svdag
| fly_0002.png
| hard.svdag
| kept.svdag
| s.ply
| soft.svdag
