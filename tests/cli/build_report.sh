# The report is JSON with the numbers of the bake.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag --report r.json -q
python3 -c '
import json
report = json.load(open("r.json"))
print(report["triangles"], report["grid"]["resolution"], report["nodes"], report["voxels"])
print(sorted(report["seconds"]), sorted(report["memory"]))'
