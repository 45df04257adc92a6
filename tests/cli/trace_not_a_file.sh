# A folder or a pipe is rejected without reading it. A file of another kind is not reported as damaged.
mkdir folder
mkfifo pipe
svdag-scene rectangle -q -o r.ply
svdag-scene scan -n 1K -q -o scan.ply
for name in folder folder/ pipe none.svdag r.ply scan.ply; do
  svdag-trace $name || echo "exit $?"
done
