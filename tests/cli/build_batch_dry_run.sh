# --dry-run with --batch predicts every bake and writes nothing; it applies to the whole list.
svdag-scene sheet -q -o a.ply
svdag build a.ply -r 64 -o old.svdag -q
cp old.svdag kept.svdag
echo '[{"scene": "a.ply", "output": "old.svdag", "resolution": 128},
       {"scene": "a.ply", "output": "new.svdag", "resolution": 256}]' > list.json
svdag build --batch list.json --dry-run -j 1 -m 200M
cmp old.svdag kept.svdag
svdag build --batch list.json --dry-run --report r.json 2>&1 || echo "exit $?"
echo '[{"scene": "a.ply", "output": "old.svdag", "resolution": 128, "dry-run": true}]' > one.json
svdag build --batch one.json 2>&1 || echo "exit $?"
cmp old.svdag kept.svdag
ls
