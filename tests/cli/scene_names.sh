# One pattern per option, so that scene files may follow; the option may be repeated.
svdag-scene city -n 3K -q -o hall.ply
svdag-scene rectangle -q -o sky1.ply
svdag-scene rectangle -q -o props.ply
svdag build hall.ply sky1.ply --exclude 'sky*' props.ply -r 64 -o a.svdag -q
svdag build hall.ply props.ply -r 64 -o b.svdag -q
cmp a.svdag b.svdag
svdag build --include 'hall*' --include props.ply hall.ply sky1.ply props.ply -r 64 -o c.svdag -q
cmp b.svdag c.svdag
svdag info --exclude 'sky*' sky1.ply hall.ply | head -n 1
svdag plan --exclude 'sky*' hall.ply --exclude 'props*' props.ply sky1.ply -r 64 --shards 1 -o p -q
svdag build hall.ply -r 64 -o hall.svdag -q
svdag run p -q -j 1
cmp p/hall.svdag hall.svdag
