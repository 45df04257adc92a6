# Inputs are never overwritten, under any of their names; this is reported before the comparison.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o a.svdag -q
cp a.svdag b.svdag
svdag export a.svdag -o a.vdb -q
ln -s b.svdag soft.svdag
ln b.svdag hard.svdag
cp b.svdag kept.svdag
for name in a.svdag b.svdag ./b.svdag soft.svdag hard.svdag; do
  svdag-verify diff a.svdag b.svdag -q --write-diff $name || echo "exit $?"
done
svdag-verify vdb a.svdag a.vdb -q --write-diff ./a.vdb || echo "exit $?"
cp a.svdag fly_0002.png  # a frame is an output, too
svdag-verify render fly_0002.png -o fly.png --fly 2 -q || echo "exit $?"
cmp fly_0002.png kept.svdag
cmp a.svdag kept.svdag
cmp b.svdag kept.svdag
ls
