# --colours writes the colours of layers beside a HashDAG; both files or none.
printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\no one\nf 1 2 3\no two\nf 2 3 4\n' > a.obj
svdag build a.obj -o a.svdag -r 1K --layers object -q
svdag build a.obj -o plain.svdag -r 1K -q
svdag build a.obj -o empty.svdag -r 64 --layers object -q --bounds=900,900,900,901,901,901
svdag export a.svdag --format hashdag -o a --colours
svdag export a.svdag --format hashdag -o b -q
ls
svdag export a.svdag --format hashdag -o a --colours -n || echo "exit $?"
rm a1k.basic_dag.dag.bin
svdag export a.svdag --format hashdag -o a --colours -n || echo "exit $?"
svdag export plain.svdag --format hashdag -o c --colours || echo "exit $?"
svdag export a.svdag --format hashdag -o c --colours --layer one || echo "exit $?"
svdag export empty.svdag --format hashdag -o c.basic_dag.dag.bin --colours || echo "exit $?"
svdag export a.svdag -o c.npz --colours || echo "exit $?"
# A limit on the file size simulates a full disk.
echo old > d1k.basic_dag.dag.bin
ulimit -f 64
svdag export a.svdag --format hashdag -o d --colours || echo "exit $?"
cat d1k.basic_dag.dag.bin
ls
