# The viewer's page as a folder, and what cannot be served.
printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
svdag build t.off -r 1K -q -o t.svdag
svdag-verify view t.svdag --to site -j 1
ls site && ls site/tiles
svdag convert t.svdag -q -o compact.svdag --layout compact && mkdir c && cp compact.svdag c/t.svdag
svdag-verify view c/t.svdag --to again -q && diff -r site again && echo "the same for every layout"
svdag-verify view t.svdag --to site -q && echo "continued"
svdag-verify view t.svdag --to site --level 9 || echo "exit $?"
svdag-verify view t.svdag --to . || echo "exit $?"
svdag-verify view t.svdag --to t.svdag || echo "exit $?"
svdag-verify view t.svdag --level 2 || echo "exit $?"
svdag-verify view t.svdag --level 11 || echo "exit $?"
svdag-verify view t.svdag --up w || echo "exit $?"
svdag-verify view t.svdag --at 70000 || echo "exit $?"
svdag-verify view t.svdag --at evil.example:80 || echo "exit $?"
svdag-verify view t.svdag --at 8123/short || echo "exit $?"
svdag-verify view t.svdag --to site --keep || echo "exit $?"
svdag-verify view t.off || echo "exit $?"
svdag build t.off -r 64 --bounds=50,50,50,60,60,60 -q -o empty.svdag
svdag-verify view empty.svdag || echo "exit $?"
