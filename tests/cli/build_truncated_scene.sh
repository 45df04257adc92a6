# The file ends within the faces; the old output is kept.
svdag-scene city -n 120 -q -o city.ply
head -c 1000 city.ply > cut.ply
printf old > out.svdag
code=0
svdag build cut.ply -r 64 -o out.svdag || code=$?
cat out.svdag
exit $code
