# Bakes that were interrupted: --resume, --restart and their scratch folders.

## build_after_killed_dry_run
# The next bake of an output removes the scratch folder of a killed dry run, but no other and none in use.
$ svdag-scene speck -n 100 -q -o s.ply
$ mkdir elsewhere
$ left() { mkdir -p -m 700 $1; touch $1/owner; echo spilled > $1/passing; }

$ left s.svdag.dry-run.scratch
$ svdag build s.ply -r 64 -o s.svdag -q
$ left s.svdag.dry-run.scratch
$ svdag build s.ply -r 64 -o s.svdag -q --dry-run
$ echo '[{"scene": "s.ply", "output": "s.svdag", "resolution": 64}]' > list.json
$ left s.svdag.dry-run.scratch
$ svdag batch list.json -q
$ find . -name '*.scratch'

# With --scratch the folder has the name that the dry run chose.
$ svdag-scene scan -n 70K -q -o scan.ply
$ svdag build scan.ply -r 8K -o scan.svdag -q -m 8M --dry-run --scratch elsewhere &
$ until test -n "$(find elsewhere -name owner)"; do sleep 0.02; done
$ kill -s KILL $! && wait $! 2>/dev/null || true
$ find elsewhere -name '*.scratch' | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
| elsewhere/scan.svdag.dry-run-HASH.scratch
$ svdag build scan.ply -r 64 -o scan.svdag -q --scratch elsewhere
$ find elsewhere -name '*.scratch'

$ left s.svdag.dry-run.scratch
$ flock s.svdag.dry-run.scratch/owner svdag build s.ply -r 64 -o s.svdag -q
$ ls s.svdag.dry-run.scratch
| owner
| passing
$ rm s.svdag.dry-run.scratch/owner
$ svdag build s.ply -r 64 -o s.svdag -q
$ ls s.svdag.dry-run.scratch
| passing
$ left s.svdag.dry-run.scratch
$ touch s.svdag.dry-run.scratch/journal
$ svdag build s.ply -r 64 -o s.svdag -q
$ ls s.svdag.dry-run.scratch
| journal
| owner
| passing

## build_dry_run_unfinished
# A dry run does not change an unfinished bake of the same output and leaves no other file.
$ svdag-scene scan -n 70K -q -o s.ply
$ mkdir beside elsewhere
$ for options in "" "--scratch elsewhere"; do
>   svdag build s.ply -r 8K -o beside/s.svdag -q -m 8M $options &
>   until test -n "$(find . -name journal)"; do sleep 0.02; done
>   sleep 0.1
>   kill -s KILL $!
>   wait $! 2>/dev/null || true
>   svdag build s.ply -r 8K -o beside/s.svdag --dry-run -q $options
>   svdag build s.ply -r 8K -o beside/s.svdag -q -m 8M $options 2>/dev/null || echo "exit code $?"
>   find beside elsewhere -name '*.scratch' | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
>   rm -rf beside/* elsewhere/*
> done
| exit code 2
| beside/s.svdag.scratch
| exit code 2
| elsewhere/s.svdag-HASH.scratch

## build_nothing_to_resume
# --resume without an unfinished bake: reports that the bake began anew, with the folder that was checked.
$ svdag-scene speck -n 2K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag --resume | tail -1
|   nothing to resume in a.svdag.scratch: it was made anew
$ mkdir elsewhere
$ svdag build a.ply -r 64 -o a.svdag --resume --scratch elsewhere | tail -1 | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
|   nothing to resume in elsewhere/a.svdag-HASH.scratch: it was made anew
$ svdag build a.ply -r 64 -o a.svdag | grep resume || echo silent
| silent

## build_restart_stopped
# --resume and --restart exclude each other: the message of an interrupted bake names a command that works.
$ stop() {  # COMMAND...: sends the signal when there is work to resume
>   env --default-signal=INT "$@" &  # background jobs of a shell ignore SIGINT
>   until ls z.svdag.scratch/journal >/dev/null 2>&1; do sleep 0.02; done
>   sleep 0.1
>   kill -s INT $!
>   wait $! || echo "exit code $?"
> }
$ svdag-scene scan -n 70K -q -o s.ply
$ stop svdag build s.ply -r 8K -m 8M -o z.svdag -q
| exit code 130
! svdag: stopped; to continue: svdag build --resume s.ply -r 8K -m 8M -o z.svdag -q
$ rm -r z.svdag.scratch
$ stop svdag build s.ply -r 8K -m 8M -o z.svdag -q --restart
| exit code 130
! svdag: stopped; to continue: svdag build --resume s.ply -r 8K -m 8M -o z.svdag -q
$ rm -r z.svdag.scratch
$ echo '[{"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M", "restart": true}]' > l.json
$ stop svdag batch l.json -q
| exit code 130
! svdag: stopped; to continue, remove "restart" from the list and repeat the command with --resume
$ rm -r z.svdag.scratch
$ echo '[{"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M"}]' > l.json
$ stop svdag batch l.json -q --restart
| exit code 130
! svdag: stopped; to continue: svdag batch --resume l.json -q
