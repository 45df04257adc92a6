# Rays need a direction even around a scene that is a single point. The thin file has no voxel, so
# nothing is judged: the result is not "ok".
printf 'v 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3\n' > point.obj
for rule in thin conservative; do
  svdag build point.obj -s 1 --rule $rule -o point.svdag -q
  svdag-verify trace point.svdag point.obj --rays 100 > answer || echo "exit $?"
  grep '^ok\|^not ok' answer || true
done
