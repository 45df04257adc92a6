# OpenVDB exports of whole files, levels and windows equal the file.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 256 -o a.svdag -q
svdag export a.svdag -o a.vdb
svdag-verify vdb a.svdag a.vdb
svdag export a.svdag -o level.vdb --level 6 --vdb-type mask
svdag-verify vdb a.svdag level.vdb
svdag export a.svdag --format vdb -o window --bounds=10,0,10,40,20,30
svdag-verify vdb a.svdag window --bounds=10,0,10,40,20,30
svdag-verify vdb a.svdag window --show 2 || echo "exit $?"
svdag export a.svdag -o fog.vdb --vdb-type float -q
svdag-verify vdb a.svdag fog.vdb --iso=0.5,1 | tail -1
svdag export a.svdag -o a.nvdb --level 7 -q
head -c 7 a.nvdb
ls
