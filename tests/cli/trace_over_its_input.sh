# The input is never overwritten, under any of its names.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o a.svdag -q
ln -s a.svdag soft.svdag
ln a.svdag hard.svdag
cp a.svdag kept.svdag
for name in a.svdag ./a.svdag soft.svdag hard.svdag; do
  svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --dump $name || echo "exit $?"
  svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --picture $name || echo "exit $?"
done
cmp a.svdag kept.svdag
ls
