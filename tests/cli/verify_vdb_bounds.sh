# The part's grid ends at 51.2. Within --bounds all voxels of the other grid count, also those beyond the file's grid.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -s 0.05 -o whole.svdag -q
svdag build a.ply -s 0.05 --bounds=10,2,10,20,9,20 -o part.svdag -q
svdag export whole.svdag -o whole.vdb -q
svdag export part.svdag -o part.vdb -q
svdag-verify vdb part.svdag whole.vdb --bounds=10,2,10,20,9,20
svdag-verify vdb part.svdag whole.vdb --bounds=10,2,10,60,9,20 --show 0 || echo "exit $?"
svdag-verify vdb part.svdag part.vdb --bounds=10,2,10,60,9,20 -q
svdag-verify vdb part.svdag whole.vdb --bounds=55,2,55,60,9,60 || echo "exit $?"
