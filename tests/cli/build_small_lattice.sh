# -s: the grid is no larger than it must be.
printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
svdag build t.off -s 1 -q -o t.svdag
svdag info t.svdag
svdag-verify mesh t.svdag t.off | tail -1
svdag build t.off -s 1e-9 -o x.svdag || echo "exit $?"
svdag build t.off -s 5cm -o x.svdag || echo "exit $?"
svdag build t.off -r 1000 -o x.svdag || echo "exit $?"
