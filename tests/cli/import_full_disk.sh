# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
svdag-scene city -n 20K -q -o a.ply
svdag build a.ply -r 512 -o a.svdag -q
svdag export a.svdag --format hashdag -o a.basic_dag.dag.bin -q
svdag export a.svdag -o a.npz -q --level 8
echo old > b.svdag
ulimit -f 8
svdag import a.basic_dag.dag.bin -o b.svdag || echo "exit $?"
svdag import a.npz -o b.svdag || echo "exit $?"
cat b.svdag
ls
