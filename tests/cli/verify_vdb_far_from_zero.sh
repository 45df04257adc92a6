# An export is compared voxel by voxel at any position and size.
judge() {
  svdag build scene.obj -r "$1" -o a.svdag -q
  svdag export a.svdag -o a.vdb -q
  svdag-verify vdb a.svdag a.vdb || echo "exit $?"
  svdag export a.svdag -o coarse.vdb -q --level 5
  svdag-verify vdb a.svdag coarse.vdb -q || echo "exit $?"
}
printf 'v 1000000000000 0 5\nv 1000000000001.3 1 5\nv 1000000000000 1 6\nf 1 2 3\n' > scene.obj
judge 1K
judge 4K
for power in -290 290; do
  printf "v 0 0 0\nv 1e$power 1e$power 0\nv 0 1e$power 1e$power\nf 1 2 3\n" > scene.obj
  judge 64
done
# A shift by a quarter of a voxel is detected there, too.
printf 'v 1000000000000 0 5\nv 1000000000001 1 5\nv 1000000000000 1 6\nf 1 2 3\n' > scene.obj
svdag build scene.obj -r 64 -o here.svdag -q
printf 'v 1000000000000.25 0 5\nv 1000000000001.25 1 5\nv 1000000000000.25 1 6\nf 1 2 3\n' > scene.obj
svdag build scene.obj -r 64 -o there.svdag -q
svdag export there.svdag -o there.vdb -q
svdag-verify vdb here.svdag there.vdb || echo "exit $?"
