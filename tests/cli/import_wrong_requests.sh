# Wrong requests: one message each.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag export a.svdag -o a.vox -q
svdag import a.svdag -o b.svdag || echo "exit $?"
svdag import a.ply -o b.svdag || echo "exit $?"
svdag import a.vox -o a.vox || echo "exit $?"
svdag import a.vox -o b.svdag -r 32 || echo "exit $?"
svdag import a.vox -o b.svdag --format foo || echo "exit $?"
svdag import a.vox -o b.svdag --format npz || echo "exit $?"
svdag import a.vox -o b.svdag --grid occupancy || echo "exit $?"
svdag import a.vox -o b.svdag --iso=0,1 || echo "exit $?"
svdag import a.vox -o b.run || echo "exit $?"
svdag import a.vox || echo "exit $?"
svdag import none.vox -o b.svdag || echo "exit $?"
ls
