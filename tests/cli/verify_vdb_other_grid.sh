# Grids that do not match the file's voxels are rejected, with the difference.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag build a.ply -s 1 -o b.svdag -q
svdag export b.svdag -o b.vdb -q
svdag-verify vdb a.svdag b.vdb || echo "exit $?"
svdag-verify vdb a.svdag a.ply || echo "exit $?"
svdag-verify vdb a.svdag none.vdb || echo "exit $?"
svdag-verify vdb a.svdag b.vdb --grid other || echo "exit $?"
svdag-verify vdb a.svdag b.vdb --iso=2,1 || echo "exit $?"
