# A plan has its own folder, which may contain the remains of a killed planning; a template for a
# farm overwrites no file of the plan.
svdag-scene rectangle -q -o triangles
mv triangles triangles.ply
mkdir mine
cp triangles.ply mine/triangles
cp triangles.ply mine/index
(cd mine && svdag plan triangles -r 64 --shards 2 -o . 2>&1) || echo "exit $?"
svdag plan triangles.ply -r 64 --shards 2 -o mine 2>&1 | sed 's/triangles\|index/FILE/' || echo "exit $?"
cmp mine/triangles triangles.ply
ls mine
svdag plan triangles.ply -r 64 --shards 2 -o p -q
cp p/plan.json kept.json
for file in plan.json index triangles runs/shard-1.run runs/merge-1.json triangles.svdag ../triangles.ply; do
  svdag submit p --engine openjd -o p/$file 2>&1 || echo "exit $?"
done
cmp kept.json p/plan.json
svdag submit p --engine openjd
svdag run p -q -j 1
rm p/plan.json
svdag plan triangles.ply -r 64 --shards 2 -o p -q
svdag run p -q -j 1
rm p/plan.json
echo notes > p/notes.txt
svdag plan triangles.ply -r 64 --shards 2 -o p 2>&1 || echo "exit $?"
