svdag-scene sheet -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q --report a.json
svdag-verify report a.svdag a.json -o a.html --size 64x36
python3 - <<'PAGE'
import base64, json, re
page = open("a.html").read()
pictures = [base64.b64decode(p, validate=True) for p in re.findall(r'src="data:image/png;base64,([^"]+)"', page)]
print(len(pictures), all(p.startswith(b"\x89PNG") for p in pictures))
print("loads nothing:", not re.search(r'(src|href)="(?!data:)|@import|url\(', page))
print("hash:", json.load(open("a.json"))["content_hash"] in page)
PAGE
svdag build a.ply -r 32 -o b.svdag -q --report b.json
svdag-verify report a.svdag b.json -o x.html 2>&1 || echo "exit $?"
echo '{"content_hash": 3}' > c.json
svdag-verify report a.svdag c.json -o x.html 2>&1 || echo "exit $?"
echo 'no JSON' > c.json
svdag-verify report a.svdag c.json -o x.html 2>&1 || echo "exit $?"
sed 's/"triangles_invalid": *[0-9]*/"triangles_invalid": 1e24/' a.json >c.json
svdag-verify report a.svdag c.json -o x.html 2>&1 || echo "exit $?"
sed 's/"cell_level": *[0-9]*/"cell_level": 40/' a.json >c.json
svdag-verify report a.svdag c.json -o x.html 2>&1 || echo "exit $?"
tr -d ' \n' < a.json | sed 's/"cubes_divided":\[[0-9]*/"cubes_divided":[1e24/' >c.json
svdag-verify report a.svdag c.json -o x.html 2>&1 || echo "exit $?"
svdag-verify report a.svdag a.json -o a.json 2>&1 || echo "exit $?"
# Verdicts are shown beside the report, which may be left out; each must be about this file.
svdag-verify mesh a.svdag a.ply --json > mesh.json
svdag-verify check a.svdag --json > check.json
svdag-verify report a.svdag mesh.json a.json check.json -o all.html --size 64x36
grep -o "<p class=\"verdict good\"><b>svdag-verify [a-z]*</b>: ok; [a-z ]*" all.html
svdag-verify report a.svdag -o bare.html --size 64x36
grep -c "Seconds per phase" all.html bare.html
svdag-scene city -n 6K -q -o city.ply
svdag-verify mesh a.svdag city.ply --sample 100 --json > wrong.json || echo "exit $?"
svdag-verify report a.svdag wrong.json -o wrong.html --size 64x36 || echo "exit $?"
svdag-verify mesh b.svdag a.ply --json > other.json
svdag-verify report a.svdag other.json -o x.html 2>&1 || echo "exit $?"
svdag-verify report a.svdag a.json a.json -o x.html 2>&1 || echo "exit $?"
sed 's/"mesh"/"bless"/' mesh.json > unknown.json
svdag-verify report a.svdag unknown.json -o x.html 2>&1 || echo "exit $?"
cut -c 1-100 mesh.json > cut.json
svdag-verify report a.svdag cut.json -o x.html 2>&1 || echo "exit $?"
