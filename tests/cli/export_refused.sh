# Exports that a format cannot hold are rejected before anything is written, with exit code 2 and a remedy.
svdag-scene speck -q -o s.ply
svdag build s.ply -r 256K -o s.svdag -q
svdag export s.svdag --format hashdag -o s || echo "exit $?"
svdag export s.svdag -o s.binvox || echo "exit $?"
svdag export s.svdag -o s.vox -q
svdag export s.svdag -o s.npz --level 7 --max-voxels 2 || echo "exit $?"
svdag export s.svdag -o s.svo --bounds=0,0,0,1,1,1 || echo "exit $?"
svdag export s.svdag --format octree -o s.oct || echo "exit $?"
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 32K -o r.svdag -q
svdag export r.svdag -o r.vox --level 14 || echo "exit $?"
svdag export r.svdag -o r.vox || echo "exit $?"
for size in 1e40 1e-300; do
  printf 'v 0 0 0\nv %s 0 0\nv 0 %s %s\nf 1 2 3\n' $size $size $size > t.obj
  svdag build t.obj -r 8 -o t.svdag -q
  svdag export t.svdag --format symvox -o t.out || echo "exit $?"
done
svdag build s.ply -r 8 --bounds=1e9,0,0,1000000001,1,1 -o t.svdag -q
svdag export t.svdag --format symvox -o t.out || echo "exit $?"
rm t.obj t.svdag
ls
