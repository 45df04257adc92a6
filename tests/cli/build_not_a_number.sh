# NaN is an error that names the triangle, unless --skip-invalid is given.
printf 'OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nnan 0 0\n1 1 1\n3 0 1 2\n3 3 4 5\n' > bad.off
code=0
svdag build bad.off -r 64 -o r.svdag || code=$?
svdag build bad.off -r 64 -o r.svdag --skip-invalid -q
exit $code
