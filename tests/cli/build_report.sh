# The report is JSON with the numbers of the bake.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag --report r.json -q
python3 -c '
import json
report = json.load(open("r.json"))
print(report["triangles"], report["grid"]["resolution"], report["nodes"], report["voxels"])
print(sorted(report["seconds"]), sorted(report["memory"]))
import os
print([(f["name"], f["bytes"] == os.path.getsize("r.ply"), len(f["hash"])) for f in report["files"]])
print(list(report["memory"]["phases"]), max(report["memory"]["phases"].values()) == report["memory"]["peak_counted"])
print(report["cell_level"])'
