# svdag plan and run: shards and merges as steps of a plan.

## plan_dry_run
$ svdag-scene city -n 5K -q -o c.ply
$ svdag build c.ply -r 512 -o c.svdag --dry-run -j 1 -m 200M
| c.svdag: 512^3, 4,992 triangles in 108 cells
|*   about * CPU seconds, * s on 1 thread
|*   a file of about * *, scratch of about 0 bytes
|*   memory of about * *, at most * * with --memory 80M
$ ls
| c.ply

## plan_colours
# The last step adds the colours: the bytes of one bake with --colours.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o one.svdag -r 128 -q --colours --colour-error 3 --allow-empty --exclude 'whole*'
$ svdag build cut.glb -o dry.svdag -r 128 --colours --dry-run -j 1 -m 200M
| dry.svdag: 128^3, 1,350 triangles in 8 cells
|*   about * CPU seconds, * s on 1 thread
|*   a file of about * *, scratch of about * *
|*   memory of about * *, at most * * with --memory 80M
|   1,200 triangles are cut out by the alpha of their material
$ svdag plan cut.glb -r 128 --shards 3 --colours --colour-error 3 --allow-empty --exclude 'whole*' -o p -m 200M
|* */p: 128^3, 1,200 triangles in * bins; one bake would take * CPU seconds
|*     3 shards: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*     1 merge: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*     1 colour pass: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*   with a machine per step: * s
|   1,200 triangles are cut out by the alpha of their material
$ svdag run p -j 2 | tail -1
|* */p/p.svdag
$ cmp one.svdag p/p.svdag
$ svdag run p --step colours | sed 's/.*p.svdag/p.svdag/'
|* p.svdag: already done, * *, content *+*
$ svdag submit p --engine openjd --program svdag -q && grep -A1 '"--step"' p/openjd.json
|        "--step",
|        "shard-{{Task.Param.Number}}"
| --
|        "--step",
|        "merge-{{Task.Param.Number}}"
| --
|        "--step",
|        "colours"
$ cp cut.glb whole.glb
$ printf x >> cut.glb
$ rm p/p.svdag
$ svdag run p -q 2>&1 | sed 's/ (.*//'
|* svdag: colours failed: */cut.glb: was changed after it was planned: restore it, or create the plan again
$ mv whole.glb cut.glb
$ svdag run p -q && cmp one.svdag p/p.svdag
$ printf 'newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n' > two.mtl  # the pass reads what the shards read
$ printf 'mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 2\n' > two.obj
$ for options in '--exclude blue' '--include blue --allow-empty --include sky' '--up z --scale 2'; do
>   svdag build two.obj -r 64 --colours $options -o two.svdag -q && rm -rf t
>   svdag plan two.obj -r 64 --shards 2 --colours $options -o t -q && svdag run t -q && cmp two.svdag t/t.svdag
> done

$ svdag plan cut.glb -r 128 --shards 2 --colour-level 5 -o q
! svdag: --colour-level requires --colours; see svdag plan --help
? 2
$ svdag plan cut.glb -r 128 --shards 2 --colours --colour-level 8 -o q
! svdag: --colour-level 8: choose 3 to 7
? 2
$ svdag plan cut.glb -r 128 --shards 2 --colours --layers material --no-union -o q
! svdag: --colours: they belong to the union: leave --no-union and --frames out
? 2
$ ls -d q
! ls: cannot access 'q': No such file or directory
? 2

## plan_colours_resume
# A killed pass continues after its last part.
$ python3 -B $TESTS/cut_scene.py 3000
$ svdag plan cut.glb -r 1K --shards 2 --colours -o p -q -m 64M
$ for step in shard-1 shard-2 merge-1; do svdag run p --step $step -q; done
$ svdag run p --step colours -q --checkpoint 0.01 &
$ until [ "$(stat -c %s p/p.svdag.scratch/journal 2>/dev/null || echo 0)" -gt 3000 ]; do sleep 0.01; done
$ kill -s KILL $! && wait $! 2>/dev/null || true
$ svdag run p --step colours | sed 's/.*p.svdag/p.svdag/'
|* p.svdag: colours is done, resumed, * *, content *
$ svdag build cut.glb -r 1K --colours -o one.svdag -q && cmp one.svdag p/p.svdag
$ ls -d p/*.scratch
! ls: cannot access 'p/*.scratch': No such file or directory
? 2

## plan_dry_run_part
# The cost of a part is not known without a plan: the prediction of the whole is not reported for it.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o x.run --part 1/2 --dry-run
! svdag: --dry-run predicts whole bakes: leave --part out, or divide the bake with svdag plan
? 2

## plan_in_use
# A step that another process runs (left by a killed run): svdag run waits for it while it runs the others.
$ svdag-scene city -n 2K -q -o c.ply
$ svdag plan c.ply -r 256 --shards 2 -o p -q
$ mkdir -m 700 p/runs/shard-1.run.scratch
$ flock p/runs/shard-1.run.scratch/owner sh -c 'touch held; for i in $(seq 200); do [ -e p/runs/shard-2.json ] || sleep 0.1; done' &
$ until [ -e held ]; do sleep 0.02; done
$ svdag run p --step shard-1
!* svdag: */p/runs/shard-1.run.scratch: another process is running shard-1 in this scratch folder: wait for it
? 75
$ svdag run p -j 1
| shard-1    waiting: another process is running it
|* shard-2    done in *
|* shard-1    done in *
|* merge-1    done in *
|* 3 of 3 steps done in *
|* */p/p.svdag
$ wait

## plan_openjd
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 3 -o p -q
$ svdag submit p --engine openjd --program svdag -o t.json
| t.json
$ sed 's/"min": [0-9]*/"min": N/' t.json
| {
|  "specificationVersion": "jobtemplate-2023-09",
|  "name": "svdag p.svdag",
|  "parameterDefinitions": [
|   {
|    "name": "Plan",
|    "type": "PATH",
|    "objectType": "DIRECTORY",
|    "dataFlow": "INOUT",
|    "description": "The folder that svdag plan wrote",
|    "default": "p"
|   },
|   {
|    "name": "Svdag",
|    "type": "STRING",
|    "description": "The program svdag on the hosts",
|    "default": "svdag"
|   }
|  ],
|  "steps": [
|   {
|    "name": "Shards",
|    "parameterSpace": {
|     "taskParameterDefinitions": [
|      {
|       "name": "Number",
|       "type": "INT",
|       "range": "1-3"
|      }
|     ]
|    },
|    "hostRequirements": {
|     "amounts": [
|      {
|       "name": "amount.worker.memory",
|       "min": N
|      },
|      {
|       "name": "amount.worker.vcpu",
|       "min": N
|      }
|     ]
|    },
|    "script": {
|     "actions": {
|      "onRun": {
|       "command": "{{Param.Svdag}}",
|       "args": [
|        "run",
|        "{{Param.Plan}}",
|        "--step",
|        "shard-{{Task.Param.Number}}"
|       ],
|       "timeout": 600
|      }
|     }
|    }
|   },
|   {
|    "name": "Merges1",
|    "parameterSpace": {
|     "taskParameterDefinitions": [
|      {
|       "name": "Number",
|       "type": "INT",
|       "range": "1-1"
|      }
|     ]
|    },
|    "hostRequirements": {
|     "amounts": [
|      {
|       "name": "amount.worker.memory",
|       "min": N
|      },
|      {
|       "name": "amount.worker.vcpu",
|       "min": N
|      }
|     ]
|    },
|    "script": {
|     "actions": {
|      "onRun": {
|       "command": "{{Param.Svdag}}",
|       "args": [
|        "run",
|        "{{Param.Plan}}",
|        "--step",
|        "merge-{{Task.Param.Number}}"
|       ],
|       "timeout": 600
|      }
|     }
|    },
|    "dependencies": [
|     {
|      "dependsOn": "Shards"
|     }
|    ]
|   }
|  ]
| }

## plan_run
$ svdag-scene city -n 5K -q -o c.ply
$ svdag build c.ply -r 512 -o one.svdag -q
$ svdag plan c.ply -r 512 --shards 5 --fan-in 2 -o p -m 200M
|* */p: 512^3, 4,992 triangles in 4 bins; one bake would take * CPU seconds
|*     5 shards: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*     6 merges: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*   with a machine per step: * s
$ rm c.ply
$ svdag run p -j 2 -q
$ cmp one.svdag p/p.svdag && echo "the same bytes"
| the same bytes
$ ls p/runs | grep -v json  # the runs are removed
? 1
$ grep -c "is done" p/logs/shard-1.log
| 1
$ svdag run p --json | grep -c '"done_before": true'
| 11
$ svdag run p --step merge-2 --json | head -4
| {
|   "name": "merge-2",
|   "state": "done",
|   "done_before": true,
$ svdag info p | grep -v input
|* */p: 512^3, 4,992 triangles in 4 bins; one bake would take * CPU seconds
|*     5 shards: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*     6 merges: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*   with a machine per step: * s
|   11 of 11 steps are done
$ svdag run p --step shard-2
|* */p/runs/shard-2.run: already merged, * *, content 3e2b85c00d01f6f5c3a35e5a8906374c
$ svdag run p --step merge-4 -q
$ svdag run p -j 2 | grep -v planned | LC_ALL=C sort
|* */p/p.svdag
| 11 of 11 steps were done before
| merge-1    already done
| merge-2    already done
| merge-3    already done
| merge-4    already done
| merge-5    already done
| merge-6    already done
| shard-1    already done
| shard-2    already done
| shard-3    already done
| shard-4    already done
| shard-5    already done

## plan_run_keep
# A slash at the end or none: the result has the name of the plan.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o here.plan/ -q
$ svdag run here.plan --keep | tail -1
|* */here.plan/here.svdag
$ ls here.plan here.plan/runs
| here.plan:
| here.svdag
| index
| logs
| plan.json
| runs
| triangles
|
| here.plan/runs:
| merge-1.json
| shard-1.json
| shard-1.run
| shard-2.json
| shard-2.run
$ mkdir in && cd in && svdag plan ../s.ply -r 64 --shards 1 -o . -q && svdag run . --json | grep '"output"'
|*   "output": "*/in/in.svdag",

## plan_run_failure
$ svdag-scene city -n 2K -q -o c.ply
$ svdag plan c.ply -r 256 --shards 2 -o p -q
$ rm p/triangles
$ svdag run p -j 1
| shard-1    failed with exit code 3
| shard-2    failed with exit code 3
|* 0 of 3 steps done in * s: * CPU seconds, at most 0 bytes of memory in a step
!* svdag: 2 steps failed, first shard-1 failed: */p/triangles: cannot be opened: no such file or folder (*/p/logs/shard-1.log)
? 3

## plan_stopped
# Interrupted by Ctrl-C, or by Slurm at its time limit, each command reports how to continue.
$ stop() {  # SIGNAL FILES COMMAND...: sends the signal when one of the files exists
>   signal=$1 files=$2
>   shift 2
>   env --default-signal=INT "$@" &  # background jobs of a shell ignore SIGINT
>   until ls $files >/dev/null 2>&1; do sleep 0.02; done
>   sleep 0.1
>   kill -s "$signal" $!
>   wait $! || echo "exit code $?"
> }
$ svdag-scene scan -n 70K -q -o s.ply
$ svdag plan s.ply -r 8K --shards 2 --scratch . -o p -q
$ stop INT 'p/runs/*.scratch/owner' svdag run p --step shard-1 -q
| exit code 130
!* svdag: shard-1 stopped; no work was saved; to begin again: svdag run /*/p --step shard-1
$ stop TERM '*.scratch/journal' svdag run p --step shard-1 -q -m 8M --scratch .
| exit code 143
!* svdag: shard-1 stopped; its work is saved; to continue: svdag run /*/p --step shard-1 --scratch=. -m 8388608
$ svdag run p --step shard-1 -q --scratch .
$ stop INT '*.scratch/owner' svdag run p -q -j 2 --scratch .
| exit code 130
! svdag: stopped; to continue: svdag run p -j 2 --scratch=.

$ svdag plan s.ply -r 1K --shards 2 -o small -q
$ mkdir -p bin
$ printf '#!/bin/sh\necho 12\n' >bin/sbatch
$ printf '#!/bin/sh\ntouch polled\necho RUNNING\n' >bin/squeue
$ chmod +x bin/*
$ PATH=$PWD/bin:$PATH
$ stop INT polled svdag submit small --engine slurm --wait -q
| exit code 130
! svdag: stopped; submitted jobs stay queued: list them with squeue --jobs=12,12, cancel them with scancel 12 12

## plan_submit_no_slurm
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ PATH=/nowhere "$(command -v svdag)" submit p --engine slurm
! svdag: sbatch: cannot be started: no such file or folder: is Slurm installed?
? 2

## plan_table
$ svdag-scene city -n 5K -q -o c.ply
$ svdag plan c.ply -r 512 --shards 2 -o p -v -m 200M
|* */p: 512^3, 4,992 triangles in 4 bins; one bake would take * CPU seconds
|*     2 shards: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*     1 merge: * CPU seconds, the longest takes * s; memory at most * *; output * *
|*   with a machine per step: * s
|
|   step            CPU s  seconds     memory     output    scratch  command
|*   shard-1 * * * * * *    0 bytes  svdag run */p --step shard-1
|*   shard-2 * * * * * *    0 bytes  svdag run */p --step shard-2
|*   merge-1 * * * * * *    0 bytes  svdag run */p --step merge-1
