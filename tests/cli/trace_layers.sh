# Rays know their layer, in both layouts; a layer is traced alone; the judge by rays compares layers.
svdag-scene atrium -q -o a.obj
for layout in plain compact; do svdag build a.obj -o $layout.svdag -r 128 -q --layers material --layout $layout; done
trace() { svdag-trace --preset inside --size 64x36 --samples 2 --rounds 1 "$@"; }
layers() { trace --json "$@" | sed 's/.*"layers": //; s/}$//' | tr '{' '\n' | grep -v '"hit": 0'; }
layers plain.svdag
layers compact.svdag | md5sum | cut -c1-8
layers plain.svdag | md5sum | cut -c1-8
svdag convert plain.svdag -o cloth.svdag -q --layer "blue cloth"
for file in "plain.svdag --layer" "compact.svdag --layer"; do trace $file "blue cloth" | grep -E "primary|results" | cut -c1-34; done
trace cloth.svdag | grep primary | cut -c1-34
trace plain.svdag --layer clot || echo "exit $?"
trace cloth.svdag --layer cloth || echo "exit $?"
svdag-verify trace plain.svdag a.obj --rays 20000 | grep -E "layers|ok"
sed 's/usemtl blue cloth/usemtl stone/' a.obj > b.obj
svdag-verify trace plain.svdag b.obj --rays 20000 > out || echo "exit $?"
grep -E "layers|ray |ok" out | cut -c1-60 | head -4
