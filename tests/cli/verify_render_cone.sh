# A cone's half angle is not negative; 0 is a value of its own, not the default.
svdag-scene speck -n 8 -q -o a.ply
svdag build a.ply -r 16 -o a.svdag -q
for cone in -1 -2 45 nan; do
  svdag-verify render a.svdag -o a.png --mode ao --cone=$cone || echo "exit $?"
done
svdag-verify render a.svdag -o a.png --mode ao --cone 0 --size 8x8
