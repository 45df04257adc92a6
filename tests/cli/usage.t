# Wrong command lines.

## usage_elsewhere
# A command of another program of the project is suggested with that program.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ for line in "check r.svdag" "verify check r.svdag" "trace r.svdag" "help render" "help svdag-trace" \
>     "import r.ply -o x.svdag" "build r.svdag -r 64 -o x.svdag"; do
>   svdag $line 2>&1 || echo "exit $?"
> done
| svdag: unknown command "check" of svdag; did you mean svdag-verify check?
| exit 2
| svdag: unknown command "verify" of svdag; did you mean svdag-verify?
| exit 2
| svdag: unknown command "trace" of svdag; did you mean svdag-trace?
| exit 2
| svdag: unknown command or topic "render"; did you mean svdag-verify render --help?
| exit 2
| svdag: unknown command or topic "svdag-trace"; did you mean svdag-trace --help?
| exit 2
| svdag: r.ply: is a mesh: bake it with svdag build
| exit 3
| svdag: r.svdag: is a .svdag, not a scene: svdag info shows what it contains
| exit 3
# The judge needs a .svdag, and names it first.
$ svdag-verify check r.ply
! svdag-verify: r.ply: is not a .svdag (its first bytes are not \x89SVDAG): svdag build makes one of a scene
? 3
$ svdag-verify mesh r.ply r.svdag
! svdag-verify: r.svdag: is the .svdag: name it before the scene
? 2
# Points are not arguments, and an option is not a topic.
$ svdag query r.svdag 1 -2 3
! svdag: points are read from standard input: echo 1 -2 3 | svdag query r.svdag
? 2
$ svdag help shards
! svdag: "shards" is an option: svdag plan --shards; see the help of these commands
? 2
$ svdag version
! svdag: unknown command "version" of svdag; did you mean svdag --version?
? 2
$ svdag build r.ply --res 64 -o x.svdag
! svdag: unknown option --res of svdag build; did you mean --resolution?
? 2
$ svdag-verify build r.ply 2>&1
| svdag-verify: unknown command "build" of svdag-verify; did you mean svdag build?
? 2

## usage_empty_name
# An empty name (an unset variable of a script) is an error before any work.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ svdag plan r.ply -r 64 --shards 1 -o p -q
$ svdag export r.svdag -o r.npz -q
$ refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
$ refused svdag-scene rectangle -o ''
| svdag-scene: -o: the value is empty; see svdag-scene --help
| exit 2
$ refused svdag build r.ply -r 64 -o ''
| svdag: -o: the value is empty; see svdag build --help
| exit 2
$ refused svdag build '' -r 64 -o x.svdag
| svdag: SCENE: the name is empty; see svdag build --help
| exit 2
$ for option in --report --scratch --cache; do
>   refused svdag build r.ply -r 64 -o x.svdag $option ''
> done
| svdag: --report: the value is empty; see svdag build --help
| exit 2
| svdag: --scratch: the value is empty; see svdag build --help
| exit 2
| svdag: --cache: the value is empty; see svdag build --help
| exit 2
$ refused svdag batch ''
| svdag: LIST: the name is empty; see svdag batch --help
| exit 2
$ refused svdag plan r.ply -r 64 --shards 1 -o ''
| svdag: -o: the value is empty; see svdag plan --help
| exit 2
$ refused svdag run ''
| svdag: PLAN: the name is empty; see svdag run --help
| exit 2
$ refused svdag submit p --engine openjd -o ''
| svdag: -o: the value is empty; see svdag submit --help
| exit 2
$ refused svdag merge ''
| svdag: RUN: the name is empty; see svdag merge --help
| exit 2
$ refused svdag info ''
| svdag: FILE: the name is empty; see svdag info --help
| exit 2
$ refused svdag export r.svdag -o ''
| svdag: -o: the value is empty; see svdag export --help
| exit 2
$ refused svdag import r.npz -o ''
| svdag: -o: the value is empty; see svdag import --help
| exit 2
$ refused svdag-verify check ''
| svdag-verify: FILE: the name is empty; see svdag-verify check --help
| exit 2
$ refused svdag-verify diff r.svdag r.svdag --write-diff ''
| svdag-verify: --write-diff: the value is empty; see svdag-verify diff --help
| exit 2
$ refused svdag-verify render r.svdag -o ''
| svdag-verify: -o: the value is empty; see svdag-verify render --help
| exit 2
$ refused svdag-trace r.svdag --dump ''
| svdag-trace: --dump: the value is empty; see svdag-trace --help
| exit 2
$ refused svdag-trace ''
| svdag-trace: FILE: the name is empty; see svdag-trace --help
| exit 2
$ ls
| p
| r.npz
| r.ply
| r.svdag

## usage_first_tries
# First attempts of new users, and the messages.
$ svdag-scene city -n 1K -q -o c.ply
$ refused() {
>   code=0
>   "$@" 2>&1 || code=$?
>   echo "exit $code"
> }
$ refused svdag build c.ply -r 64
| svdag: --output is required; see svdag build --help
| exit 2
$ refused svdag build c.ply -r 64 -o c.vdb
| svdag: c.vdb: the output must end in .svdag or .run: use svdag export for other formats
| exit 2
$ refused svdag build c.ply -r 64 -o -
| svdag: -: the output must end in .svdag or .run: use svdag export for other formats
| exit 2
$ refused svdag build - -r 64 -o c.svdag
| svdag: -: standard input is not supported: name an input file
| exit 2
$ refused svdag build c.ply -r 64 -o c.svdag --rule fat
| svdag: --rule: unknown rule "fat": choose conservative, thin or solid
| exit 2
$ refused svdag merge a.run -o c.vdb
| svdag: c.vdb: the output must end in .svdag or .run: use svdag export for other formats
| exit 2
$ svdag build c.ply -r 64 -o c.svdag -q
$ refused svdag export c.svdag -o d.svdag --level 5
| svdag: d.svdag: to write the .svdag of SymVox, add --format symvox
| exit 2
$ refused svdag-verify render c.svdag -o c.jpg
| svdag-verify: c.jpg: pictures are PNG: choose a name in .png
| exit 2
$ echo '[{"scene": "c.ply", "output": "d.svdag", "reslution": 64}]' >l.json
$ refused svdag batch l.json
| svdag: l.json: bake 1: unknown option --reslution of svdag build; did you mean --resolution?
| exit 2
$ svdag build c.ply -r 64 -o e.svdag --bounds=0,500,0,4,503,4 | grep "no voxel"
|   no voxel is set: 0 triangles meet the grid
$ svdag --help build | head -1
| Bake scene files as one .svdag
$ svdag --version --nothing
| svdag 0.1.0
$ svdag -V
| svdag 0.1.0
$ ls
| c.ply
| c.svdag
| e.svdag
| l.json

## usage_lost_values
# An unset $OUT in a script: the next word is not taken as the value, and nothing is written.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
$ refused svdag build r.ply -r 64 -o --quiet
| svdag: -o: its value is missing before --quiet; see svdag build --help
| exit 2
$ refused svdag build r.ply -o -r 64
| svdag: -o: its value is missing before -r; see svdag build --help
| exit 2
$ refused svdag build r.ply -r 64 -o x.svdag --report -q
| svdag: --report: its value is missing before -q; see svdag build --help
| exit 2
$ refused svdag build r.ply -r 64 -o=x.svdag
| svdag: -o=x.svdag: the value starts with "=": remove the "="; see svdag build --help
| exit 2
$ refused svdag build r.ply -r 64 --output=
| svdag: --output: the value is empty; see svdag build --help
| exit 2
$ refused svdag build r.ply -r '' -o x.svdag
| svdag: -r: the value is empty; see svdag build --help
| exit 2
$ refused svdag build r.ply -s '' -o x.svdag
| svdag: -s: the value is empty; see svdag build --help
| exit 2
$ refused svdag build r.ply -r 64 -o x.svdag -j ''
| svdag: -j: the value is empty; see svdag build --help
| exit 2
$ refused svdag plan r.ply -r 64 --shards 1 -o --quiet
| svdag: -o: its value is missing before --quiet; see svdag plan --help
| exit 2
$ refused svdag export r.svdag -o x.npz --level ''
| svdag: --level: the value is empty; see svdag export --help
| exit 2
$ refused svdag import r.svdag -o x.svdag --grid ''
| svdag: --grid: the value is empty; see svdag import --help
| exit 2
$ refused svdag-verify mesh r.svdag r.ply --seed ''
| svdag-verify: --seed: the value is empty; see svdag-verify mesh --help
| exit 2
$ refused svdag-verify mesh r.svdag r.ply --sample 9 --seed -1
| svdag-verify: --seed: "-1" is not a whole number from 0 to 2^64 - 1; see svdag-verify mesh --help
| exit 2
$ refused svdag-verify diff r.svdag r.svdag --show ''
| svdag-verify: --show: the value is empty; see svdag-verify diff --help
| exit 2
$ refused svdag-verify render r.svdag -o --size 9x9
| svdag-verify: -o: its value is missing before --size; see svdag-verify render --help
| exit 2
$ refused svdag-verify render r.svdag -o x.png --fly ''
| svdag-verify: --fly: the value is empty; see svdag-verify render --help
| exit 2
$ refused svdag-scene city --seed 99999999999999999999 -o c.ply
| svdag-scene: --seed: "99999999999999999999" is not a whole number from 0 to 2^64 - 1; see svdag-scene --help
| exit 2
$ refused svdag-scene city -n '' -o c.ply
| svdag-scene: -n: the value is empty; see svdag-scene --help
| exit 2
# Negative numbers are values, and unusual names are accepted.
$ svdag build r.ply -r 64 -o ./--quiet.svdag -q --bounds -1,-1,-1,1,1,1
$ svdag build r.ply -r 64 -q --output==x.svdag
$ svdag build -r 64 -q -o y.svdag -- r.ply
$ ls
| --quiet.svdag
| =x.svdag
| r.ply
| r.svdag
| y.svdag

## usage_no_command
$ svdag
!* svdag: *see svdag --help
? 2

## usage_typo
$ for line in "biuld x.ply" "build x.ply -o x.svdag --resolutoin 64" "info --jsno x.svdag"; do
>   svdag $line 2>&1 || echo "exit $?"
> done
| svdag: unknown command "biuld" of svdag; did you mean build?
| exit 2
| svdag: unknown option --resolutoin of svdag build; did you mean --resolution?
| exit 2
| svdag: unknown option --jsno of svdag info; did you mean --json?
| exit 2
$ for line in "chekc x.svdag" "mesh x.svdag x.ply --smaple 3"; do
>   svdag-verify $line 2>&1 || echo "exit $?"
> done
| svdag-verify: unknown command "chekc" of svdag-verify; did you mean check?
| exit 2
| svdag-verify: unknown option --smaple of svdag-verify mesh; did you mean --sample?
| exit 2

## usage_unknown_command
$ svdag bake
!* svdag: *see svdag --help
? 2

## usage_version
$ svdag --version
| svdag 0.1.0
$ svdag-verify --version
| svdag-verify 0.1.0

## usage_zero
# Zero is a value, not the default; an invalid one gives a short message.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
$ refused svdag export r.svdag -o r.ply.npz --level 0
| svdag: --level 0: r.svdag has the levels 3 to 6
| exit 2
$ refused svdag-verify render r.svdag -o r.png --level 0
| svdag-verify: --level: r.svdag has levels 1 to 6 to trace
| exit 2
$ refused svdag-verify render r.svdag -o r.png --level 7
| svdag-verify: --level: r.svdag has levels 1 to 6 to trace
| exit 2
$ for command in 'svdag build r.ply -r 64 -o x.svdag' 'svdag plan r.ply -r 64 --shards 1 -o p' \
>     'svdag info r.ply' 'svdag export r.svdag -o r.vdb' 'svdag import r.npz -o x.svdag' \
>     'svdag-verify mesh r.svdag r.ply'; do
>   refused $command -m 0
>   refused $command -m 16
> done
| svdag: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag-verify: --memory: 0 is less than 1M: give a size such as 512M or 4G
| exit 2
| svdag-verify: --memory: 16 is less than 1M: give a size such as 512M or 4G
| exit 2
$ for seconds in 0 -1 nan; do
>   refused svdag build r.ply -r 64 -o x.svdag --checkpoint=$seconds
> done
| svdag: --checkpoint: must be more than 0 seconds
| exit 2
| svdag: --checkpoint: must be more than 0 seconds
| exit 2
| svdag: --checkpoint: must be more than 0 seconds
| exit 2
$ refused svdag-verify mesh r.svdag r.ply --sample 0
| svdag-verify: --sample: give at least one
| exit 2
$ refused svdag-verify mesh r.svdag r.ply --judge openvdb --sample 0
| svdag-verify: --sample: give at least one
| exit 2
$ refused svdag-verify render r.svdag -o r.png --fly 0
| svdag-verify: --fly: give 1 to 9999 frames
| exit 2
$ refused svdag merge r.run -o ''
| svdag: -o: the value is empty; see svdag merge --help
| exit 2
$ refused svdag build r.ply -r 64 -o x.svdag --checkpoint soon
| svdag: --checkpoint: "soon" is not a number; see svdag build --help
| exit 2
$ svdag-verify render r.svdag -o r.png --level 6 --size 8x8 -q
$ svdag build r.ply -r 64 -o x.svdag --checkpoint 0.5 -q
$ ls
| r.ply
| r.png
| r.svdag
| x.svdag

## usage_names_with_control_characters
# A terminal gets no control character of a file name.
$ name=$(printf 'a\033[31mb\nc')
$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > "$name.obj"
$ {
>   svdag info "$name.obj"
>   svdag build "$name.obj" -o "$name.svdag" -r 64
>   svdag build "$name.obj" -o "$name.svdag" -r 64 --dry-run
>   svdag info "$name.svdag"
>   svdag convert "$name.svdag" -o "$name.2.svdag" --layout compact
>   svdag pack "$name.svdag" -o "$name.pack"
>   svdag unpack "$name.pack" -o "$name.3.svdag"
>   svdag edit "$name.svdag" -o "$name.4.svdag" --level 5
>   svdag export "$name.svdag" -o "$name.npz"
>   svdag import "$name.npz" -o "$name.5.svdag"
>   svdag-verify check "$name.svdag"
>   svdag-verify render "$name.svdag" -o "$name.png" --size 8x8
>   svdag-verify report "$name.svdag" -o "$name.html" --size 64x36
>   svdag-verify view "$name.svdag" --to "$name"
> } > out 2>&1
$ grep -c 'a?\[31mb?c' out | awk '$1 >= 12 { print "all named" }'
| all named
$ LC_ALL=C grep -c '[[:cntrl:]]' out
| 0
? 1

## usage_little_memory
# No program is ended by a library that cannot start its threads.
$ for limit in 100 120 135 140 145 150 155 160 170 200; do
>   for program in svdag svdag-verify svdag-trace svdag-export svdag-import; do
>     code=0
>     (ulimit -v $((limit * 1024)); $program --version >/dev/null 2>message) || code=$?
>     case $code in 0|5|127) ;; *) echo "$program: $code"; cat message ;; esac
>   done
> done

## usage_range_once
$ svdag pack --help | grep zstd
|   --level N                 Level of zstd, 1 to 19 (default: 5)
