# svdag info, query and view.

## info_broken
# One damaged byte is detected, and its position is reported.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ printf 'X' | dd of=r.svdag bs=1 seek=1100 conv=notrunc 2>/dev/null
$ svdag info r.svdag
! svdag: r.svdag: damaged file: a block does not match its checksum (at byte 1024)
? 3

## info_full_output
# A full output device is an error, for output of any length and every program.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ svdag-scene hairball -n 2K -q -o h.ply
$ svdag build h.ply -r 64 -o h.svdag -q
$ for words in "svdag info r.ply" "svdag --version" "svdag-verify --version" "svdag-verify --help" "svdag-scene --version" \
>     "svdag-trace --version" "svdag help grid" "svdag --manual-json" "svdag-export --version" "svdag-import --help" \
>     "svdag-verify diff r.svdag h.svdag --by-index --show 100000 --json"; do
>   $words > /dev/full 2> message && echo "not refused: $words" || echo "exit $?"
>   cat message
> done
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag-verify: the result could not be written to standard output
| exit 4
| svdag-verify: the result could not be written to standard output
| exit 4
| svdag-scene: the result could not be written to standard output
| exit 4
| svdag-trace: the result could not be written to standard output
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag: the result could not be written to standard output
| exit 4
| svdag-verify: the result could not be written to standard output
$ svdag --version >&- 2> message
? 4
$ cat message
| svdag: the result could not be written to standard output

## info_symvox
# A SymVox .svdag is distinguished from this project's, which has a magic number.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 256 -o r.svdag -q
$ svdag export r.svdag --format symvox -o other.svdag -q
$ svdag info other.svdag
! svdag: other.svdag: is a SymVox .svdag: convert it with svdag import
? 3
$ svdag-verify check other.svdag
! svdag-verify: other.svdag: is a SymVox .svdag: convert it with svdag import
? 3
$ svdag-verify diff other.svdag r.svdag
! svdag-verify: other.svdag: is a SymVox .svdag: convert it with svdag import
? 3
$ svdag export other.svdag -o x.vox
! svdag: other.svdag: is a SymVox .svdag: convert it with svdag import
? 3
$ head -c 40 other.svdag > cut.svdag
$ svdag-verify check cut.svdag
! svdag-verify: cut.svdag: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene
? 3
$ svdag import other.svdag -o back.svdag -q
$ svdag-verify diff back.svdag r.svdag
| compared  at 256^3, 637 pairs of nodes
| both      79,262 voxels
| only A    0
| only B    0
| clusters  0
| same

## query
# Points are set, empty or outside; the box of the answer holds the point.
$ printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
$ svdag build t.off -s 1 -q -o t.svdag
$ printf '5 0 0\n5,0.2,0.1\n0 10 0\n\n-9 9 9\n1e300 0 0\n' | svdag query t.svdag
| set 5  4.5 -0.5 -0.5  5.5 0.5 0.5
| set 5  4.5 -0.5 -0.5  5.5 0.5 0.5
| empty 2  -7.5 8.5 -7.5  0.5 16.5 0.5
| empty 2  -15.5 8.5 8.5  -7.5 16.5 16.5
| outside
$ for i in $(seq 100); do echo $i $((i % 7)) 0.25; done > points  # answered together, and one by one
$ for option in '' --nearest; do
>   while read point; do echo $point | svdag query t.svdag $option; done < points > alone
>   svdag query t.svdag $option < points | cmp - alone
> done
$ (head -40 points; echo 1 2) | svdag query t.svdag | wc -l
| 40
! svdag: standard input: line 41 is not a point: give x y z
$ echo 1 2 | svdag query t.svdag
! svdag: standard input: line 1 is not a point: give x y z
? 3
$ echo 1 2 x | svdag query t.svdag
! svdag: standard input: line 1 is not a point: give x y z
? 3
$ echo 1 2 nan | svdag query t.svdag
! svdag: standard input: line 1 is not a point: give x y z
? 3
$ svdag query missing.svdag < /dev/null
! svdag: missing.svdag: cannot be opened: no such file or folder
? 3
$ printf '5 0 0\n\377\000 2 3\n' | svdag query t.svdag
| set 5  4.5 -0.5 -0.5  5.5 0.5 0.5
! svdag: standard input: line 2 is not a point: give x y z
? 3
$ printf '1 2 3\000\n' | svdag query t.svdag
! svdag: standard input: line 1 is not a point: give x y z
? 3
$ head -c 70000 /dev/zero | tr '\000' 1 | svdag query t.svdag
! svdag: standard input: line 1 is longer than 65536 bytes
? 3
$ svdag query t.svdag < .
! svdag: standard input: cannot be read: it is a folder
? 3
$ printf '5 0 0' | svdag query t.svdag
| set 5  4.5 -0.5 -0.5  5.5 0.5 0.5

## query_nearest
# The nearest voxel, its distance in world units and its box; points may be outside of the grid.
$ printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
$ svdag build t.off -s 1 -q -o t.svdag
$ printf '5 0 0\n5 -3 0\n5 5 5\n-100 0 0\n1e300 0 0\n' | svdag query t.svdag --nearest
| near 0  4.5 -0.5 -0.5  5.5 0.5 0.5
| near 2.5  4.5 -0.5 -0.5  5.5 0.5 0.5
| near 0  4.5 4.5 4.5  5.5 5.5 5.5
| near 99.5  -0.5 -0.5 -0.5  0.5 0.5 0.5
| none
$ printf '5 -3 0\n5 -3.5 0\n' | svdag query t.svdag --nearest --max-distance 2.5
| near 2.5  4.5 -0.5 -0.5  5.5 0.5 0.5
| none
$ echo 1 2 3 | svdag query t.svdag --max-distance 1
! svdag: --max-distance requires --nearest; see svdag query --help
? 2
$ echo 1 2 3 | svdag query t.svdag --nearest --max-distance=-1
! svdag: --max-distance: must be 0 or more
? 2

## view
# The viewer's page as a folder, and what cannot be served.
$ printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
$ svdag build t.off -r 1K -q -o t.svdag
$ svdag-verify view t.svdag --to site -j 1
| site: 8 tiles, about 664 bytes
| site: written, 664 bytes
$ ls site && ls site/tiles
| camera.js
| index.html
| scene.json
| served.js
| tiles
| tiles.js
| trace.js
| view.css
| view.js
| 1
| 2
| 3
| 4
| 5
| 6
| 7
| 8
$ svdag convert t.svdag -q -o compact.svdag --layout compact && mkdir c && cp compact.svdag c/t.svdag
$ svdag-verify view c/t.svdag --to again -q && diff -r site again && echo "the same for every layout"
| the same for every layout
$ svdag-verify view t.svdag --to site -q && echo "continued"
| continued
$ svdag-verify view t.svdag --to site --level 9
| site: 1 tile, about 155 bytes
! svdag-verify: site: holds the page of another scene or level; choose another folder
? 2
$ svdag-verify view t.svdag --to .
| .: 8 tiles, about 664 bytes
! svdag-verify: .: is not empty and not such a page; choose another folder
? 2
$ svdag-verify view t.svdag --to t.svdag
| t.svdag: 8 tiles, about 664 bytes
! svdag-verify: t.svdag: cannot be created: its path leads through a file
? 4
$ svdag-verify view t.svdag --level 2
! svdag-verify: --level: t.svdag has levels 3 to 10 to show
? 2
$ svdag-verify view t.svdag --level 11
! svdag-verify: --level: t.svdag has levels 3 to 10 to show
? 2
$ svdag-verify view t.svdag --up w
! svdag-verify: --up: "w" is not one of x, y, z; see svdag-verify view --help
? 2
$ svdag-verify view t.svdag --at 70000
! svdag-verify: --at: "70000" is not PORT or PORT/TOKEN with 16 or more letters and digits
? 2
$ svdag-verify view t.svdag --at evil.example:80
! svdag-verify: --at: "evil.example:80" is not PORT or PORT/TOKEN with 16 or more letters and digits
? 2
$ svdag-verify view t.svdag --at 8123/short
! svdag-verify: --at: "8123/short" is not PORT or PORT/TOKEN with 16 or more letters and digits
? 2
$ svdag-verify view t.svdag --to site --keep
! svdag-verify: --to cannot be combined with --keep; see svdag-verify view --help
? 2
$ svdag-verify view t.off
! svdag-verify: t.off: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene
? 3
$ svdag build t.off -r 64 --bounds=50,50,50,60,60,60 -q -o empty.svdag
$ svdag-verify view empty.svdag
! svdag-verify: empty.svdag: has no voxel to show
? 2

## info_parts_in_memory
# The list of parts is counted before it is made.
$ awk 'BEGIN { print "v 0 0 0\nv 1 0 0\nv 0 1 1"; for (i = 0; i < 400000; i++) printf "o part%d\nf 1 2 3\n", i }' > many.obj
$ svdag info many.obj --parts -m 32M
!* svdag: *parts need * MiB in total, *
? 5
$ svdag info many.obj --parts --json -m 128M
!* svdag: *parts need * MiB in total, *
? 5
$ svdag info many.obj --parts -m 256M | tail -n 1
|          400,000  file:many.obj  (0, 0, 0) .. (1, 1, 1)
