# A limit on the file size simulates a full disk; the old file is kept.
printf old > city.ply
ulimit -f 8
code=0
svdag-scene city -n 100K -o city.ply || code=$?
cat city.ply
ls
exit $code
