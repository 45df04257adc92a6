# A scene that was compressed with gzip, in every format: same voxels, and nothing is left behind.
svdag-scene city -n 6K -q -o city.ply
svdag build city.ply -o plain.svdag -r 256 -q
gzip -k city.ply
svdag build city.ply.gz -o a.svdag -r 256 -m 3M -q && cmp plain.svdag a.svdag
mv city.ply.gz noname
svdag build noname -o a.svdag -r 256 -q && cmp plain.svdag a.svdag
cat > t.obj <<'OBJ'
v 0 0 0
v 9 0 1
v 0 7 2
f 1 2 3
OBJ
printf 'OFF\n3 1 0\n0 0 0\n9 0 1\n0 7 2\n3 0 1 2\n' > t.off
printf 'solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 9 0 1\nvertex 0 7 2\nendloop\nendfacet\nendsolid\n' > t.stl
svdag build t.obj -o t.svdag -r 64 -q
for name in t.obj t.off t.stl; do
  gzip $name
  svdag build $name.gz -o a.svdag -r 64 --scratch . -q && cmp t.svdag a.svdag
done
svdag info t.obj.gz | head -2
svdag-verify mesh t.svdag t.off.gz | tail -1
svdag plan t.stl.gz -r 64 -o plan --shards 2 -q
svdag run plan -q && cmp t.svdag plan/t.svdag
head -c 20 t.obj.gz > short.obj.gz
svdag build short.obj.gz -o b.svdag -r 64 || echo "exit $?"
TMPDIR=/nowhere svdag info t.obj.gz | head -1
ls -A
