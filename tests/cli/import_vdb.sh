# OpenVDB decodes in a separate process; --sandbox gives the same result.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag export a.svdag -o a.vdb -q
head -c 9000 a.vdb > cut.vdb
for sandbox in "" --sandbox; do
  svdag import a.vdb -o b.svdag $sandbox
  svdag-verify diff a.svdag b.svdag -q
  svdag-verify vdb a.svdag a.vdb -q $sandbox
  svdag import cut.vdb -o c.svdag $sandbox || echo "exit $?"
  svdag-verify vdb a.svdag cut.vdb $sandbox || echo "exit $?"
done
ls
