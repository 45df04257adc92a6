# The names that --include matches; a pattern that matches nothing is an error, or reported with --allow-empty.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng wall\nf 1 2 3\nf 1 2 4\ng roof\nf 2 3 4\n' >house.obj
svdag info house.obj --parts | tail -n 4
svdag info house.obj --json --parts | tail -n 11
svdag build house.obj -r 64 -o house.svdag --include wall --include windw --exclude 'sky*' --allow-empty | tail -n +2
svdag build house.obj -r 64 -o house.svdag --include windw --allow-empty || echo "exit $?"
svdag plan house.obj -r 64 --shards 2 -o house.plan --exclude 'sky*' --allow-empty | tail -n 1
svdag info house.obj --levels || echo "exit $?"
svdag info house.plan --parts || echo "exit $?"
