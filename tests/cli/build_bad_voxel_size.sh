svdag-scene rectangle -q -o r.ply
for size in 0 -1 nan inf 1e-310; do
  code=0
  svdag build r.ply "--voxel-size=$size" -o r.svdag || code=$?
  echo "$size: $code"
done
ls
