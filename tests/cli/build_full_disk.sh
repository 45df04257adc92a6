# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
svdag-scene city -n 60K -q -o city.ply
echo old > city.svdag
ulimit -f 8
code=0
svdag build city.ply -r 1K -o city.svdag -q || code=$?
cat city.svdag
ls
exit $code
