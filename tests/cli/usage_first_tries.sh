# First attempts of new users, and the messages.
svdag-scene city -n 1K -q -o c.ply
refused() {
  code=0
  "$@" 2>&1 || code=$?
  echo "exit $code"
}
refused svdag build c.ply -r 64
refused svdag build c.ply -r 64 -o c.vdb
refused svdag build c.ply -r 64 -o -
refused svdag build - -r 64 -o c.svdag
refused svdag build c.ply -r 64 -o c.svdag --rule fat
refused svdag merge a.run -o c.vdb
svdag build c.ply -r 64 -o c.svdag -q
refused svdag export c.svdag -o d.svdag --level 5
refused svdag-verify render c.svdag -o c.jpg
echo '[{"scene": "c.ply", "output": "d.svdag", "reslution": 64}]' >l.json
refused svdag build --batch l.json
svdag build c.ply -r 64 -o e.svdag --bounds=0,500,0,4,503,4 | grep "no voxel"
svdag --help build | head -1
svdag --version --nothing
svdag -V
ls
