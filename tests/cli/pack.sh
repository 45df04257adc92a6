# A packed file unpacks byte for byte, and is taken in place of a .svdag; damage is found and named.
svdag-scene city -n 2K -q -o city.ply
svdag build city.ply -q -o city.svdag -r 256
svdag convert city.svdag -q -o small.svdag --layout compact
svdag pack city.svdag -o city.svdag.pack
svdag pack small.svdag -q -o small.pack && cmp city.svdag.pack small.pack && echo "every layout packs to the same bytes"
svdag unpack city.svdag.pack -o again.svdag
cmp city.svdag again.svdag && echo same
svdag info city.svdag.pack | head -1
svdag-verify check city.svdag.pack | tail -1
svdag-verify diff city.svdag.pack city.svdag -q && echo "the same voxels"
svdag edit city.svdag.pack -q -o coarse.svdag --level 6 && svdag info coarse.svdag | head -1
svdag-trace city.svdag.pack || echo "exit $?"
svdag pack city.svdag -o city.zst || echo "exit $?"
svdag unpack city.svdag -o other.svdag || echo "exit $?"
{ head -c 2000 city.svdag.pack; printf X; tail -c +2002 city.svdag.pack; } > bad.pack
svdag unpack bad.pack -o bad.svdag || echo "exit $?"
test ! -e bad.svdag && echo "no output"
head -c 3000 city.svdag.pack > short.pack; svdag unpack short.pack -o bad.svdag || echo "exit $?"
