# Without the plane memo and with every instruction set, the bytes are the same.
svdag-scene city -n 6K --yaw 30 -q -o city.ply
svdag build city.ply -r 1K -o best.svdag --report best.json -q
svdag build city.ply -r 1K -o alone.svdag --report alone.json -q --no-plane-memo
cmp best.svdag alone.svdag
names=$(svdag build city.ply -r 64 -o none.svdag --vectors none 2>&1 | sed 's/.*choose one of //; s/,//g')
for name in $names; do
  svdag build city.ply -r 1K -o same.svdag --report report.json -q --vectors "$name"
  cmp best.svdag same.svdag
done
svdag build city.ply -r 1K -o same.svdag -q --vectors PLAIN
python3 -c '
import json
best, alone, plain = (json.load(open(f"{name}.json")) for name in ["best", "alone", "report"])
print("computed with the memo:", best["plane_memo"]["computed"] > 0, "without:", alone["plane_memo"]["computed"])
print(plain["vectors"], plain["lanes"], "vectors differ:", plain["vectors"] != best["vectors"])'
