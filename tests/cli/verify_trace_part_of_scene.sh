# A file of one of two triangles is right for that one; the grid shows that the other is missing. A
# file restricted by --bounds is judged within them, and a mistyped pattern is reported.
printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\n' > one.obj
printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\nv 90 90 90\nv 94 90 90\nv 90 94 91\nf 4 5 6\n' > two.obj
svdag build one.obj -r 64 -o one.svdag -q
svdag build two.obj -r 64 --bounds=0,0,0,4,4,1 -o part.svdag -q
svdag-verify trace one.svdag two.obj --rays 1K > answer || echo "exit code $?"
grep '^defect\|^triangles\|^in grid\|^late\|^far\|^ok\|^not ok' answer | sed 's/: on .*//; s/ of .*//'
svdag-verify trace one.svdag two.obj --rays 1K --json | grep -o '"ok":[a-z]*\|"triangles[a-z_]*":[0-9]*'
svdag-verify trace part.svdag two.obj --rays 1K --exclude 'sky*' --allow-empty > answer
grep '^defect\|^triangles\|^unmatched\|^in grid\|^outside\|^ok' answer | sed 's/ of .*//'
