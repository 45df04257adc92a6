# Bakes of a list that run at once write the same files and the same report, in the order of the list.
svdag-scene city -n 6K -q -o a.ply
svdag-scene sheet -q -o b.ply
cat > list.json <<'LIST'
[{"scene": "a.ply", "output": "a.svdag", "resolution": "512"},
 {"scene": "b.ply", "output": "b.svdag", "resolution": "64"},
 {"scene": "a.ply", "output": "thin.svdag", "resolution": "256", "rule": "thin", "memory": "1G"}]
LIST
done_in() { python3 -c 'import json, sys; r = json.load(sys.stdin); print([(d["output"], d["exit"], d["report"]["memory"]["peak_counted"] <= 1 << 28) for d in r["done"]])'; }
svdag build --batch list.json -P 3 -m 768M --json | done_in
mkdir at_once
mv *.svdag at_once
svdag build --batch list.json -q --report - | done_in
for file in *.svdag; do cmp $file at_once/$file; done
# A failure ends the list; bakes that have begun are finished.
echo '[{"scene": "a.ply", "output": "c.svdag", "resolution": "64"}, {"scene": "b.ply", "output": "d/d.svdag", "resolution": "64"}]' > bad.json
{ svdag build --batch bad.json -P 2 2>&1 || echo "exit $?"; } | sed "s|, [0-9.]* s\$||"
ls *.svdag
svdag build a.ply -o x.svdag -r 64 -P 2 2>&1 || echo "exit $?"
# They may share a cache.
svdag build --batch list.json -P 3 -q --cache cells
for file in at_once/*.svdag; do cmp $file ${file#at_once/}; done
svdag build --batch list.json -q --cache cells --json | python3 -c 'import json, sys; r = json.load(sys.stdin); print(all(d["report"]["cache_hits"] == d["report"]["cells"] for d in r["done"]))'
