# Rays miss triangles of zero area; points on the surface show that a file lacks their voxels.
# The thin rule sets no voxel for them, so nothing is judged: the result is not "ok".
printf 'v 0 0 0\nv 1 2 3\nv 2 1 0\nf 1 2 2\nf 2 3 3\nf 3 1 1\n' > segments.obj
printf 'v 9 9 9\nv 8 9 9\nv 9 8 9\nf 1 2 3\n' > elsewhere.obj
bounds=--bounds=-1,-1,-1,4,4,4
for rule in conservative thin; do
  svdag build segments.obj -r 64 $bounds --rule $rule -o segments.svdag -q
  svdag build elsewhere.obj -r 64 $bounds --rule $rule -o empty.svdag -q
  for file in segments empty; do
    echo "$rule, $file"
    svdag-verify trace $file.svdag segments.obj --rays 10K > answer || echo "exit code $?"
    grep "^late\|^uncovered\|^ok\|^not ok" answer || continue  # nothing was judged
    grep "^  point" answer | head -1 | sed 's/(.*)/(...)/'
  done
done
svdag build segments.obj -r 64 $bounds -o segments.svdag -q
svdag-verify trace segments.svdag segments.obj --rays 1 --json | grep -o '"points":[0-9]*'
