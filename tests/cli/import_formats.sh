# An export is imported as the same DAG; content identifies the format.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 256 -o a.svdag -q
svdag export a.svdag --format hashdag -o a.basic_dag.dag.bin -q
svdag export a.svdag --format symvox -o symvox.svdag -q
for f in a.svo a.npz a.binvox a.vox; do svdag export a.svdag -o $f -q; done
for f in a.basic_dag.dag.bin symvox.svdag a.svo a.npz a.binvox a.vox; do
  svdag import $f -o b.svdag -r 256
  svdag-verify check b.svdag -q
  svdag-verify diff a.svdag b.svdag --by-index -q
done
# The points of an export are neither voxels with a grid nor triangles.
svdag export a.svdag -o points.ply -q
svdag import points.ply -o back.svdag || echo "exit $?"
svdag build points.ply -o back.svdag -r 64 || echo "exit $?"
