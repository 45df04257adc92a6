# -n: an existing output is kept, and a batch skips it.
svdag-scene speck -n 100 -q -o s.ply
svdag build s.ply -r 64 -o a.svdag -q -n
cp a.svdag kept.svdag
svdag build s.ply -r 32 -o a.svdag -q -n || echo "exit $?"
svdag export a.svdag -o kept.svdag --format symvox -n || echo "exit $?"
svdag export a.svdag -o a.npz -q --no-clobber
svdag import a.npz -o a.svdag -n || echo "exit $?"
cmp a.svdag kept.svdag
echo '[{"scene": "s.ply", "output": "a.svdag"}, {"scene": "s.ply", "output": "b.svdag"}]' > list.json
svdag build --batch list.json -r 32 -n | tail -3 | sed "s|, [0-9.]* s$||"
cmp a.svdag kept.svdag
