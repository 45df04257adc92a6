# A cube, shifted by less than a voxel and slightly enlarged: the same indices at other positions.
cube() {
  printf 'OFF\n8 6 0\n'
  for x in $1 $2; do for y in 0 $3; do for z in 0 $3; do echo $x $y $z; done; done; done
  printf '4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n'
}
cube 0 1 1 > cube.off
cube 0.0009 1.0009 1 > moved.off
cube 0 1.0005 1.0005 > larger.off
for name in cube moved larger; do svdag build $name.off -r 1K -o $name.svdag -q; done
svdag build cube.off -r 512 -o half.svdag -q
svdag build moved.off -r 512 -o half_moved.svdag -q
for name in cube moved larger half half_moved; do
  echo $name
  svdag-verify diff cube.svdag $name.svdag -q || echo "exit $?"
  svdag-verify diff $name.svdag cube.svdag -q --by-index || echo "exit $?"
done
# Formats that store the position as float32 are at the same position; so is a level of the grid.
svdag export moved.svdag --format symvox -o other.svdag -q
svdag import other.svdag -o back.svdag -q
svdag-verify diff back.svdag moved.svdag
svdag export moved.svdag -o level.npz -q --level 8
svdag import level.npz -o level.svdag -q
svdag-verify diff moved.svdag level.svdag
