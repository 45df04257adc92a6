# The counts of svdag-trace as JSON; hits and hash are those of the table.
svdag-scene city -n 6K -q -o city.ply
svdag build city.ply -o city.svdag -r 256 -q
svdag-trace city.svdag --size 64x48 --samples 4 --rounds 1 -j 1 > table
svdag-trace city.svdag --size 64x48 --samples 4 --rounds 1 -j 1 --json > json
python3 - <<'CHECK'
import json
traced = json.load(open("json"))
lines = open("table").read().splitlines()
print(lines[0] == traced["device"], lines[-1].split()[1] == traced["results"])
for line, work in zip(lines[2:], traced["workloads"]):
    print(work["workload"], line.split()[:3] == [work["workload"], str(work["rays"]), str(work["hit"])], work["seconds"] > 0)
CHECK
