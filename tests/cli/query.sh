# Points are set, empty or outside; the box of the answer holds the point.
printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
svdag build t.off -s 1 -q -o t.svdag
printf '5 0 0\n5,0.2,0.1\n0 10 0\n\n-9 9 9\n1e300 0 0\n' | svdag query t.svdag
echo 1 2 | svdag query t.svdag || echo "exit $?"
echo 1 2 x | svdag query t.svdag || echo "exit $?"
echo 1 2 nan | svdag query t.svdag || echo "exit $?"
svdag query missing.svdag < /dev/null || echo "exit $?"
printf '5 0 0\n\377\000 2 3\n' | svdag query t.svdag || echo "exit $?"
printf '1 2 3\000\n' | svdag query t.svdag || echo "exit $?"
head -c 70000 /dev/zero | tr '\000' 1 | svdag query t.svdag || echo "exit $?"
svdag query t.svdag < . || echo "exit $?"
printf '5 0 0' | svdag query t.svdag
