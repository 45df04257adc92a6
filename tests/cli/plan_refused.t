# Plans and steps that are rejected.

## plan_edited
# A plan that was edited is rejected by every command, whatever was changed.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ cp p/plan.json kept.json
$ for edit in 's/"voxel_size": /"voxel_size": 1/' 's/"rule": "conservative"/"rule": "thin"/' 's/"bounded": false/"bounded": true/' \
>   's/p.svdag/t.svdag/' 's/"format": 11,/"format":  11,/'; do
>   sed "$edit" kept.json > p/plan.json
>   cmp -s kept.json p/plan.json && echo "nothing is changed by $edit"
>   svdag run p -q -j 1 2>&1 || echo "exit $?"
> done
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
| exit 3
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
| exit 3
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
| exit 3
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
| exit 3
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
| exit 3
$ svdag run p --step shard-1 2>&1
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
? 3
$ svdag info p 2>&1
|* svdag: */p/plan.json: was changed after it was planned: create the plan again with svdag plan
? 3
$ cp kept.json p/plan.json
$ svdag run p -q -j 1

## plan_exists
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ svdag plan s.ply -r 64 --shards 2 -o p/
!* svdag: */p: contains a plan, which cannot be changed: choose another folder
? 2

## plan_foreign_run
$ svdag-scene city -n 2K -q -o a.ply
$ svdag-scene city -n 2K --seed 2 -q -o b.ply
$ svdag plan a.ply -s 0.5 --shards 1 -o p -q
$ svdag plan b.ply -s 0.5 --shards 1 -o q -q
$ svdag run q -q --keep
$ svdag run p --step shard-1 -q
$ cp q/runs/shard-1.run p/runs/shard-1.run
$ svdag run p --step merge-1
!* svdag: */p/runs/shard-1.run: not the output of step shard-1 of this plan (of another or older plan, or damaged): run step shard-1 again
? 3

## plan_merge_too_early
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ svdag run p --step shard-1 -q
$ svdag run p --step merge-1
!* svdag: */p/runs/shard-2.run: is missing: run step shard-2 of the plan first
? 3

## plan_misplaced
# A plan instead of a scene or a run, and words that a plan's commands would ignore: each is rejected with a message.
$ refused() { "$@" 2>&1 || echo "exit $?"; }
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ refused svdag build p -o z.svdag -r 64
| svdag: p is a plan: bake it with svdag run
| exit 2
$ refused svdag build s.ply p -o z.svdag -r 64 --dry-run
| svdag: p is a plan: bake it with svdag run
| exit 2
$ refused svdag run p --step shard-1 s.ply
| svdag: unexpected argument: s.ply; see svdag run --help
| exit 2
$ refused svdag merge p -o z.svdag
| svdag: p is a plan: bake it with svdag run
| exit 2
$ refused svdag merge p p -o z.svdag
| svdag: p is a plan: bake it with svdag run
| exit 2
$ refused svdag submit p --engine slurm -o t.json
| svdag: --engine slurm submits jobs: leave --output out, which is for openjd
| exit 2
$ refused svdag submit p p --engine slurm
| svdag: p: one plan is submitted at a time; options for the engine begin with a dash and follow --
| exit 2
$ refused svdag submit p --engine openjd --wait
| svdag: --engine openjd writes a template: leave --wait out, which is for slurm
| exit 2
$ for option in '--include x' '--exclude x' --skip-invalid --sandbox; do refused svdag info p $option; done
| svdag: --include: p is a plan
| exit 2
| svdag: --exclude: p is a plan
| exit 2
| svdag: --skip-invalid: p is a plan
| exit 2
| svdag: --sandbox: p is a plan
| exit 2
$ svdag run p -q -j 1 --keep
$ refused svdag info p/p.svdag --include x
| svdag: --include: p/p.svdag is a .svdag
| exit 2
$ refused svdag info p/runs/shard-1.run --sandbox
| svdag: --sandbox: p/runs/shard-1.run is a run
| exit 2
$ refused svdag run p --step shard-1 -o z.svdag
| svdag: z.svdag: shard-1 makes a run: choose an output that ends in .run
| exit 2
$ refused svdag run p --step merge-1 -o z.run
| svdag: z.run: merge-1 makes a .svdag: choose an output that does not end in .run
| exit 2
$ refused svdag run p --step merge-1 -o z.vdb
| svdag: z.vdb: the output must end in .svdag or .run: use svdag export for other formats
| exit 2
$ svdag info p | tail -n 1
|   3 of 3 steps are done
$ ls
| p
| s.ply

## plan_no_shard
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ svdag run p --step shard-3
! svdag: the plan has no step shard-3: svdag info PLAN --levels lists its steps
? 2

## plan_not_utf8
# A plan stores its paths in JSON and rejects paths that JSON cannot represent.
$ latin=$(printf 'caf\351')
$ svdag-scene city -n 3K -q -o good.ply
$ cp good.ply "$latin.ply"
$ svdag plan "$latin.ply" -r 64 --shards 2 -o a.plan 2> answer
? 2
$ svdag plan good.ply -r 64 --shards 2 -o "$latin.plan" 2>> answer
? 2
$ grep -c 'is not valid UTF-8' answer
| 2
$ svdag build "$latin.ply" -r 64 -o dry.svdag --dry-run -q
$ svdag plan good.ply -r 64 --shards 2 -o good.plan -q
$ ls -d *.plan
| good.plan
$ mv good.plan "$latin.plan"
$ svdag submit "$latin.plan" --engine openjd -o openjd.json 2> answer
? 2
$ grep -c 'is not valid UTF-8' answer
| 1
$ svdag run "$latin.plan" -q

## plan_other_version
# Every command recognises a plan of another version of svdag and does not change it.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ sed -i 's/"format": [0-9]*/"format": 4/' p/plan.json
$ cp p/plan.json kept.json
$ svdag run p -j 1 2>&1
|* svdag: */p/plan.json: written by another version of svdag: create the plan again with svdag plan
? 3
$ svdag run p --step shard-1 2>&1
|* svdag: */p/plan.json: written by another version of svdag: create the plan again with svdag plan
? 3
$ svdag info p 2>&1
|* svdag: */p/plan.json: written by another version of svdag: create the plan again with svdag plan
? 3
$ svdag plan s.ply -r 64 --shards 2 -o p 2>&1
|* svdag: */p: contains a plan, which cannot be changed: choose another folder
? 2
$ cmp kept.json p/plan.json
$ rm p/plan.json
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ svdag run p -q -j 1

## plan_over_files
# A plan has its own folder, which may contain the remains of a killed planning; a template for a
# farm overwrites no file of the plan.
$ svdag-scene rectangle -q -o triangles
$ mv triangles triangles.ply
$ mkdir mine
$ cp triangles.ply mine/triangles
$ cp triangles.ply mine/index
$ (cd mine && svdag plan triangles -r 64 --shards 2 -o . 2>&1)
| svdag: ./triangles is also an input, which is never overwritten: choose another output
? 2
$ svdag plan triangles.ply -r 64 --shards 2 -o mine 2>&1 | sed 's/triangles\|index/FILE/'
|* svdag: */mine: contains FILE, which is not a file of a plan: choose another folder
$ cmp mine/triangles triangles.ply
$ ls mine
| index
| triangles
$ svdag plan triangles.ply -r 64 --shards 2 -o p -q
$ cp p/plan.json kept.json
$ for file in plan.json index triangles runs/shard-1.run runs/merge-1.json p.svdag ../triangles.ply; do
>   svdag submit p --engine openjd -o p/$file 2>&1 || echo "exit $?"
> done
| svdag: p/plan.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/index is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/triangles is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/shard-1.run is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/merge-1.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/p.svdag is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/../triangles.ply is also an input, which is never overwritten: choose another output
| exit 2
$ cmp kept.json p/plan.json
$ svdag submit p --engine openjd
|* */p/openjd.json
$ svdag run p -q -j 1
$ rm p/plan.json
$ svdag plan triangles.ply -r 64 --shards 2 -o p -q
$ svdag run p -q -j 1
$ rm p/plan.json
$ echo notes > p/notes.txt
$ svdag plan triangles.ply -r 64 --shards 2 -o p 2>&1
|* svdag: */p: contains notes.txt, which is not a file of a plan: choose another folder
? 2

## plan_step_of_scene
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag run s.ply --step shard-1
! svdag: s.ply: not a plan folder: plan.json is missing (create one with svdag plan)
? 3

## plan_step_options
# A step has only the options that it honours, since the plan sets the others; those need a step.
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ for options in '--step shard-1 -r 64' '--step shard-1 --resume' '--step shard-0' '--step nonsense' '-o o.run' '-m 64M' \
>                '--checkpoint 5' --restart -v; do
>   svdag run p $options || echo "exit code $?"
> done
| exit code 2
| exit code 2
| exit code 2
| exit code 2
| exit code 2
| exit code 2
| exit code 2
| exit code 2
| exit code 2
! svdag: unknown option -r of svdag run; see svdag run --help
! svdag: unknown option --resume of svdag run; see svdag run --help
! svdag: the plan has no step shard-0: svdag info PLAN --levels lists its steps
! svdag: the plan has no step nonsense: svdag info PLAN --levels lists its steps
! svdag: --output requires --step; see svdag run --help
! svdag: --memory requires --step; see svdag run --help
! svdag: --checkpoint requires --step; see svdag run --help
! svdag: --restart requires --step; see svdag run --help
! svdag: --verbose requires --step; see svdag run --help
$ ls
| p
| s.ply
$ svdag run p --step shard-1 -o o.run --scratch . -m 64M -j 1 --checkpoint 5 --restart --no-progress -v | grep -v seconds
| o.run: shard-1 is done, 1.6 KiB, content 74e4d98906c530d910ad91e145882e0b

## plan_step_over_files
# A step writes to the requested output, but never over a file of the plan, of another step, or of the scene.
$ svdag-scene sheet -q -o s.ply
$ svdag plan s.ply -r 64 --shards 2 -o p -q
$ svdag run p --step shard-1 -q
$ svdag run p --step shard-2 -q
$ cp -r p kept
$ cp s.ply kept.ply
$ ln p/index link
$ for output in s.ply p/plan.json p/index link p/triangles p/runs/shard-2.run p/runs/shard-1.json p/runs/merge-1.json \
>               p/p.svdag; do
>   svdag run p --step shard-1 -o $output 2>&1 || echo "exit $?"
> done
| svdag: s.ply is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/plan.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/index is also an input, which is never overwritten: choose another output
| exit 2
| svdag: link is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/triangles is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/shard-2.run is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/shard-1.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/merge-1.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/p.svdag is also an input, which is never overwritten: choose another output
| exit 2
$ for output in ./s.ply p/plan.json p/triangles p/runs/shard-1.run p/runs/shard-2.json; do
>   svdag run p --step merge-1 -o $output 2>&1 || echo "exit $?"
> done
| svdag: ./s.ply is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/plan.json is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/triangles is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/shard-1.run is also an input, which is never overwritten: choose another output
| exit 2
| svdag: p/runs/shard-2.json is also an input, which is never overwritten: choose another output
| exit 2
$ diff -r kept p
$ cmp kept.ply s.ply
$ svdag run p --step shard-1 -o ./p/runs/shard-1.run -q
$ svdag run p --step shard-2 -o mine.run -q
$ svdag run p --step merge-1 -o mine.svdag -q
$ svdag run p --step merge-1 -o p/p.svdag -q
$ cmp mine.svdag p/p.svdag
$ cmp mine.run p/runs/shard-2.run
