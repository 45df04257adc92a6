# NanoVDB is written but not read; --iso is rejected for a grid without values.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag export a.svdag -o a.vdb -q
svdag export a.svdag -o a.nvdb -q
svdag import a.nvdb -o b.svdag || echo "exit $?"
svdag-verify vdb a.svdag a.nvdb || echo "exit $?"
svdag import a.vdb -o b.svdag --iso=0,1 || echo "exit $?"
svdag-verify vdb a.svdag a.vdb --iso=0,1 || echo "exit $?"
svdag export a.svdag -o b.nvdb --vdb-type mask || echo "exit $?"
svdag export a.svdag -o b.npz --vdb-type bool || echo "exit $?"
ls
