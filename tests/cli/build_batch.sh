# Two good bakes; then a list with a bake that fails between them, with and without --keep-going.
svdag-scene sheet -q -o a.ply
svdag-scene city -n 6K -q -o b.ply
cat > good.json <<'LIST'
[{"scene": "a.ply", "output": "a.svdag", "resolution": 256, "quiet": true},
 {"scene": ["a.ply", "b.ply"], "output": "ab.svdag", "voxel-size": 4, "rule": "thin"}]
LIST
svdag build --batch good.json -q -j 1 --report all.json
svdag build b.ply a.ply -o one.svdag -s 4 --rule thin -q
cmp ab.svdag one.svdag
python3 -c 'import json; r = json.load(open("all.json")); print(r["bakes"], [(d["output"], d["exit"], d["report"]["threads"]) for d in r["done"]])'
cat > bad.json <<'LIST'
[{"scene": "missing.ply", "output": "m.svdag", "resolution": "1K"},
 {"scene": "a.ply", "output": "a2.svdag", "resolution": "256"}]
LIST
svdag build --batch bad.json 2>&1 || echo "exit $?"
svdag build --batch bad.json --keep-going --report bad_report.json -q 2>&1 || echo "exit $?"
cmp a.svdag a2.svdag
echo '[{"scene": "a.ply", "output": "x.svdag"}]' > incomplete.json
svdag build --batch incomplete.json 2>&1 || echo "exit $?"
echo '[{"scene": "a.ply", "output": "x.svdag", "resolution": 64}, {"scene": "b.ply", "output": "x.svdag", "resolution": 64}]' > twice.json
svdag build --batch twice.json 2>&1 || echo "exit $?"
echo '{"scene": 7' > broken.json
svdag build --batch broken.json 2>&1 || echo "exit $?"
ls
