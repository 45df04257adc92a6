# Wrong requests: one message each, exit code 2.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag export a.svdag -o a.txt || echo "exit $?"
svdag export a.svdag -o a.vdb --format foo || echo "exit $?"
svdag export a.svdag -o a.vdb --level 7 || echo "exit $?"
svdag export a.svdag -o a.vdb --bounds=1,2,3 || echo "exit $?"
svdag export a.svdag -o a.svdag --format vdb || echo "exit $?"
svdag export a.svdag -o a.vdb --max-voxels 3 || echo "exit $?"
svdag export a.svdag || echo "exit $?"
svdag export none.svdag -o a.vdb || echo "exit $?"
ls
# Every file that a format writes is checked, not only the named one.
cp a.svdag x.octreenodes
cp a.svdag y.svdag
ln -s y.svdag y.octreedata
svdag export x.octreenodes --format octree -o x.octree || echo "exit $?"
svdag export y.svdag -o y.octree || echo "exit $?"
cmp a.svdag x.octreenodes
cmp a.svdag y.svdag
ls
