# Known hashes of every format that needs no library. An .octree is three files.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag export r.svdag -o r64.basic_dag.dag.bin
svdag export r.svdag --format symvox -o r.symvox
svdag export r.svdag -o r.svo
svdag export r.svdag -o r.octree
svdag export r.svdag -o r.npz
svdag export r.svdag -o r.binvox
svdag export r.svdag -o r.vox
svdag export r.svdag -o r.ply2 --format ply
svdag export r.svdag -o r16.svo --level 4
rm r.ply r.svdag
sha256sum *
