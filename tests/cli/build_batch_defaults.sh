# Options given with --batch are defaults of every bake; options that cannot apply to a list are rejected.
svdag-scene city -n 3K -q -o a.ply
echo '[{"scene": "a.ply", "output": "thin.svdag"},
       {"scene": "a.ply", "output": "said.svdag", "voxel-size": 4, "rule": "conservative"},
       {"scene": "a.ply", "output": "half.run", "part": "1/2", "quiet": false},
       {"scene": "a.ply", "output": "quiet.svdag", "quiet": true}]' > list.json
svdag build --batch list.json -r 64 --rule thin --bounds=0,0,0,100,100,100 -j 1 --checkpoint 5 | sed 's/:.*//'
svdag build a.ply -r 64 --rule thin --bounds=0,0,0,100,100,100 -o t.svdag -q
svdag build a.ply -s 4 --bounds=0,0,0,100,100,100 -o s.svdag -q
cmp t.svdag thin.svdag
cmp t.svdag quiet.svdag
cmp s.svdag said.svdag
echo '[{"scene": ["a.ply", "a.ply"], "output": "all.svdag", "exclude": ["a.*", "b.*"]},
       {"scene": "a.ply", "output": "none.svdag"}]' > names.json
svdag build --batch names.json -r 64 --include '*.ply' --exclude 'a*' --keep-going 2>&1 || echo "exit $?"
for wrong in a.ply '-o x.svdag' '--shard 1' '--part 1/2' '-r 64 -s 1'; do
  svdag build --batch list.json $wrong 2>&1 || echo "exit $?"
done
for wrong in '"help": true' '"r": 64' '"shard": 1' '"keep-going": true' '"batch": "list.json"'; do
  echo '[{"scene": "a.ply", "output": "x.svdag", "resolution": 64, '"$wrong"'}]' > wrong.json
  svdag build --batch wrong.json 2>&1 || echo "exit $?"
done
echo '[{"scene": "a.ply", "output": "x.svdag", "skip-invalid": false}]' > wrong.json
svdag build --batch wrong.json -r 64 --skip-invalid 2>&1 || echo "exit $?"
echo '[{"scene": "a.ply", "output": "small.svdag", "cache-size": "1M"}]' > small.json
svdag build --batch small.json -r 64 --cache cells -q
svdag build --batch small.json -r 64 -q 2>&1 || echo "exit $?"
svdag build a.ply -o x.svdag -r 64 --keep-going 2>&1 || echo "exit $?"
ls
