# With the report of an earlier run, bakes are skipped whose inputs, options and output are unchanged.
svdag-scene sheet -q -o a.ply
svdag-scene city -n 6K -q -o b.ply
list() { echo '[{"scene": "a.ply", "output": "a.svdag", "resolution": "64"}, {"scene": "b.ply", "output": "b.svdag", "resolution": "'"$1"'"}]' > list.json; }
bake() { svdag build --batch list.json --report r.json "$@" | sed 's/: .*s$/: baked/' && cp r.json last.json; }
list 64
bake
echo "the same again"
bake
bake -q
python3 -c 'import json; print([(d["output"], d["exit"], d.get("up_to_date"), d["report"]["voxels"] > 0) for d in json.load(open("r.json"))["done"]])'
echo "another resolution"
list 128
bake
echo "an input of the same name and another content"
svdag-scene scan -n 2K -q -o a.ply
bake
echo "a copy of the input, with another time"
cp a.ply c.ply && mv c.ply a.ply
bake
echo "another output of that name"
svdag build a.ply -o b.svdag -r 64 -q
bake
echo "a missing output, and a truncated one"
rm a.svdag
truncate -s -8 b.svdag
bake
echo "no report, and a file that is not one"
rm r.json
bake
echo '{"done": [{"output": "a.svdag"}]}' > r.json
bake
echo "damaged reports"
for text in '' '[' '[]' '7' '{"done": 7}' '{"done": [[]]}' '{"done": [{"exit": 0, "output": 7, "report": {}}]}' \
  '{"done": [{"exit": 0, "output": "a.svdag", "report": {"description_hash": 1, "content_hash": []}}]}'; do
  echo "$text" > r.json
  bake -q
done
head -c 900 last.json > r.json
bake -q
python3 -c 'print("{\"done\": " + 100000 * "[")' > r.json
bake
bake
