# --help, svdag help and --version.

## help_command
# The same as --help, also for commands that are separate programs.
$ for command in build merge plan run submit info export import help; do
>   svdag help $command >of_help
>   svdag $command --help >of_option
>   cmp of_help of_option && echo "$command: $(wc -l <of_help | awk '{ print ($1 > 8 ? "complete" : "too short") }')"
> done
| build: complete
| merge: complete
| plan: complete
| run: complete
| submit: complete
| info: complete
| export: complete
| import: complete
| help: complete

## help_narrow
$ COLUMNS=40 svdag submit --help
| Submit a plan to a farm
| Usage: svdag submit --engine NAME
|     [OPTIONS] PLAN [OPTION...]
|
| Arguments:
|   PLAN
|       The folder of a plan
|   OPTION...
|       slurm: after --, options for
|       sbatch
|
| Options:
|   -h, --help
|       Print this help message and exit
|   --engine NAME
|       slurm (submits jobs) or openjd
|       (writes a template)
|   --wait
|       slurm: wait until the plan is done
|   --program FILE
|       svdag on the other machines
|       (default: this file)
|   -o, --output FILE
|       openjd: the template to write
|       (default: PLAN/openjd.json)
|   --scratch DIR
|       Folder on the machines for spilled
|       data (a relative path begins here)
|   --keep
|       Keep the runs, which the last step
|       removes when the output is done
|   -q, --quiet
|       Print errors only
|
| Examples:
|   svdag submit city.plan \
|     --engine slurm --wait -- \
|     --partition=bake
|   svdag submit city.plan \
|     --engine openjd \
|     -o city.openjd.json
|
| Exit codes: 0 ok, 1 differs, 2 usage, 3
| bad input, 4 disk or output, 5 memory
| limit, 128 + n stopped by signal n.
$ COLUMNS=40 svdag-verify --help
| Judges .svdag files independently of the
| builder.
| Usage: svdag-verify COMMAND [OPTIONS]
|
| Commands:
|   check
|       Prove every checksum and pointer,
|       order and minimality
|   mesh
|       Voxelize the scene again, by other
|       means, and compare every voxel
|   colours
|       Compute colours of the scene
|       again, by other means, and compare
|   diff
|       Count and list the voxels that
|       only one DAG has
|   vdb
|       Compare every voxel with an
|       OpenVDB grid
|   trace
|       Send rays through the DAG and
|       through the triangles (by Embree),
|       and compare
|   render
|       Make a picture by tracing rays
|       through the DAG
|   report
|       Make an HTML page about a .svdag:
|       pictures, verdicts, levels, times
|   view
|       Fly through the voxels in the
|       browser
|
| Options:
|   -h, --help
|       Print this help message and exit
|   -V, --version
|       Print the version and exit
|
| Examples:
|   svdag-verify check scene.svdag
|   svdag-verify mesh scene.svdag \
|     scene.ply
|
| Exit codes: 0 ok, 1 differs, 2 usage, 3
| bad input, 4 disk or output, 5 memory
| limit, 128 + n stopped by signal n.

## help_topic
$ svdag help rules
| rules: when a voxel is set
|
| The rule decides which voxels a scene sets. All rules are evaluated exactly, in
| integers, without a tolerance: no voxel is missing and none is extra, at any
| resolution.
|
| conservative, the default, sets every voxel whose closed cube a triangle
| touches, even at a corner. A face on the plane between two layers sets both.
| Nothing in the scene is lost: use it for collisions, visibility and lighting.
|
|     svdag build hall.ply -o hall.svdag -r 8K
|
| thin sets a voxel if a triangle crosses one of the three segments of a voxel's
| length through its centre, parallel to the axes. That is often 1.05 (walls) to
| 1.9 (curved surfaces) times fewer voxels. The surface is still watertight for
| steps through faces (6-separating): use it for rays and for display. Triangles
| smaller than a voxel may set none.
|
|     svdag build hall.ply -o thin.svdag -r 8K --rule thin
|
| solid sets what conservative sets, and the inside of closed surfaces: the voxels
| around which they wind. Use it for occupancy, printing and simulation. A scene
| that is not closed is an error that says where; --open surface bakes its open
| objects as surfaces. If the triangles are not oriented alike, --inside odd
| counts as inside what a ray enters an odd number of times.
|
|     svdag build scan.ply -o solid.svdag -r 8K --rule solid
|
| points is the rule of svdag import for point clouds: a voxel holds a point. The
| lower planes of a voxel belong to it, so each point sets exactly one.
|
| With conservative and thin, the inside of a closed mesh stays empty. Files store
| their rule. A judge that shares only the readers and the snap with the builder
| recomputes every voxel; diff counts the voxels that only one of two files has
| (exit code 1):
|
|     svdag-verify mesh thin.svdag hall.ply
|     svdag-verify diff thin.svdag hall.svdag
$ COLUMNS=44 svdag help exit-codes
| exit-codes: how programs report success and
| failure
|
| Results go to standard output; errors and
| progress go to standard error. Every failure
| prints one message and returns a code:
|
|     0        done; the same
|     1        it differs: a judge found a
|              difference (svdag-verify,
|              svdag-trace)
|     2        usage: the command line is
|              wrong, or cannot run now
|     3        an input is missing, damaged or
|              of the wrong kind
|     4        the disk is full, or the output
|              cannot be written
|     5        the memory budget, or the
|              machine's memory, is too small
|     70       a defect of the program; please
|              report it
|     75       another process is doing this
|              step of a plan: wait for it
|     128 + n  stopped by signal n; 130 is
|              Ctrl-C
|
| A bake cannot run now if an unfinished bake
| of the output exists (choose --resume or
| --restart), or if another process is baking
| it (wait for it).
|
| 4, 5 and 128 + n may be temporary: free disk
| space or give more memory, then resume the
| saved work:
|
|     svdag build scan.ply -o scan.svdag \
|       -r 16K --resume
|
| In a script, print nothing but errors:
|
|     svdag build city.glb -o city.svdag \
|       -r 4K --quiet
|     svdag-verify check city.svdag --quiet
|
| For machine-readable output use --report
| (svdag build) and --json (svdag info of
| files; svdag-verify check, mesh, colours,
| diff, vdb, trace); docs/reports.md lists the
| keys:
|
|     svdag build city.glb -o city.svdag \
|       -r 4K --report city.json
|     svdag info city.svdag --json

## help_topics
$ svdag help
| Bakes triangle scenes as sparse voxel DAGs.
| Usage: svdag COMMAND [OPTIONS]
|
| Commands:
|   build                     Bake scene files as one .svdag
|   batch                     Bake each entry of a list
|   merge                     Join the runs of parts of one bake
|   plan                      Divide a bake into jobs for a farm
|   run                       Run a plan on this machine, or one of its steps
|   submit                    Submit a plan to a farm
|   info                      Describe a .svdag, a run, a plan or a scene
|   query                     Look up points in a .svdag
|   edit                      Combine, crop or coarsen .svdag files
|   colour                    Add the colours of its scene to a .svdag
|   convert                   Write a .svdag in another layout, or one of its
|                             layers
|   pack                      Compress a .svdag for shipping
|   unpack                    Write the .svdag of a .pack
|   export                    Write the voxels of a .svdag in another format
|   import                    Convert voxels of another program to a .svdag
|   help                      Explain a command or a topic
|
| Options:
|   -h, --help                Print this help message and exit
|   -V, --version             Print the version and exit
|
| Topics:
|   grid         how the voxel grid is placed
|   rules        when a voxel is set
|   layers       materials, objects or files in one DAG
|   colours      a colour for every voxel
|   memory       scenes and DAGs that do not fit
|   farm         one bake as many jobs
|   formats      what is read and written
|   exit-codes   how programs report success and failure
|
| svdag-verify checks and renders .svdag files; svdag-trace traces rays through
| them.
|
| Examples:
|   svdag build city.glb -o city.svdag -r 64K
|   svdag help build
|   svdag help grid
|
| Exit codes: 0 ok, 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory
| limit, 128 + n stopped by signal n.

## help_typo
$ for subject in grdi ruels biuld exitcodes frobnicate; do
>   svdag help $subject 2>&1 || echo "exit $?"
> done
| svdag: unknown command or topic "grdi"; did you mean grid?
| exit 2
| svdag: unknown command or topic "ruels"; did you mean rules?
| exit 2
| svdag: unknown command or topic "biuld"; did you mean build?
| exit 2
| svdag: unknown command or topic "exitcodes"; did you mean exit-codes?
| exit 2
| svdag: unknown command or topic "frobnicate"; svdag help lists them
| exit 2
