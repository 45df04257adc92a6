# A scene of a format that is not read: the message names the format and a way to convert it.
for name in a.blend a.abc a.usdz a.step cloud.las scene.obj.zst a.vdb; do
  echo data > $name
  svdag build $name -r 64 -o r.svdag || echo "exit $?"
done
printf 'BLENDER-v300' > unnamed
svdag build unnamed -r 64 -o r.svdag || echo "exit $?"
mkdir folder
svdag build folder -r 64 -o r.svdag || echo "exit $?"
svdag build https://example.org/a.glb -r 64 -o r.svdag || echo "exit $?"
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n' > points.ply
svdag build points.ply -r 64 -o r.svdag || echo "exit $?"
