# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 256 -o a.svdag -q
for f in a.svo a.npz a.octree a.basic_dag.dag.bin; do echo old > $f; done
ulimit -f 8
for f in a.svo a.npz a.octree a.basic_dag.dag.bin; do
  svdag export a.svdag -o $f || echo "exit $?"
done
cat a.svo a.npz a.octree a.basic_dag.dag.bin
ls
