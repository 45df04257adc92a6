# A file converts to the compact layout and back, byte for byte; every program takes either.
svdag-scene city -n 2K -q -o city.ply
svdag build city.ply -q -o plain.svdag -r 256
svdag convert plain.svdag -o small.svdag --layout compact
svdag convert small.svdag -q -o back.svdag --layout plain && cmp plain.svdag back.svdag
svdag build city.ply -q -o built.svdag -r 256 --layout compact && cmp small.svdag built.svdag
svdag build city.ply -q -o a.run -r 256 --part 1/2 && svdag build city.ply -q -o b.run -r 256 --part 2/2
svdag merge a.run b.run -q -o merged.svdag --layout compact && cmp small.svdag merged.svdag
svdag edit plain.svdag -q -o whole.svdag --bounds=-1e9,-1e9,-1e9,1e9,1e9,1e9 --layout compact
svdag-verify diff whole.svdag plain.svdag -q && echo "the edit has the same voxels"
svdag export small.svdag -q -o small.npz && svdag import small.npz -q -o imported.svdag --layout compact
svdag export small.svdag -q -o small.svo && svdag export plain.svdag -q -o plain.svo && cmp small.svo plain.svo
svdag-verify diff small.svdag imported.svdag -q && echo "the import has the same voxels"
svdag-verify check small.svdag | tail -1
svdag-verify mesh small.svdag city.ply -q && echo "the judge agrees"
for file in plain small; do svdag-trace "$file.svdag" --size 64x64 --samples 2 --rounds 1 | tail -1; done | uniq | wc -l
svdag info small.svdag --levels | tail -3
svdag convert plain.svdag -o plain.svdag --layout compact || echo "exit $?"
svdag convert plain.svdag -o other.svdag || echo "exit $?"
svdag build city.ply -o a.run -r 64 --layout compact || echo "exit $?"
svdag plan city.ply -q -o city.plan -r 64 --shards 1 && svdag merge city.plan --step final --layout compact || echo "exit $?"
