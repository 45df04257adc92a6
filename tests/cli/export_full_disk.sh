# OpenVDB does not report a full disk; svdag does. The old file is kept, no other file remains.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 256 -o a.svdag -q
echo old > a.vdb
ulimit -f 8
svdag export a.svdag -o a.nvdb || echo "exit $?"
code=0
svdag export a.svdag -o a.vdb || code=$?
cat a.vdb
ls
exit $code
