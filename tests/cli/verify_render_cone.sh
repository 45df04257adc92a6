# Half an angle is not negative, whatever the number; 0 and the default are none of each other.
svdag-scene speck -n 8 -q -o a.ply
svdag build a.ply -r 16 -o a.svdag -q
for cone in -1 -2 45 nan; do
  svdag-verify render a.svdag -o a.png --mode ao --cone=$cone || echo "exit $?"
done
svdag-verify render a.svdag -o a.png --mode ao --cone 0 --size 8x8
