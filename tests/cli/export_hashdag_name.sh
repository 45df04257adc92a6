# HashDAG prescribes the file name: DIR/NAME is extended to it.
svdag-scene speck -q -o s.ply
svdag build s.ply -r 128K -o s.svdag -q
mkdir data
svdag export s.svdag --format hashdag -o data/speck
svdag export s.svdag --format hashdag -o data/speck --level 10 -q
ls data
svdag export s.svdag --format hashdag -o data/speck --level 9
