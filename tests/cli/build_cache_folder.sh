# An existing folder keeps its permissions; a world-writable one is rejected.
svdag-scene city -n 3K -q -o city.ply
mkdir group everybody
chmod 2775 group
chmod 1777 everybody
svdag build city.ply -r 256 -q -o a.svdag --cache group
svdag build city.ply -r 256 -q -o b.svdag --cache everybody || echo "exit $?"
svdag build city.ply -r 256 -q -o c.svdag --cache new
stat -c '%a %n' group everybody new
ls everybody
ls *.svdag
