# --cube: grids of one cube line up; from 64K on the coarser ones are the parents of the finer ones.
svdag-scene speck -n 300 -q -o s.ply
for r in 1K 64K 256K 1M; do svdag build s.ply -r $r --cube=-70,-70,-70,140 -q -o $r.svdag; done
svdag info 1K.svdag | head -3
svdag-verify mesh 1K.svdag s.ply | grep '^missing\|^extra\|^ok'
svdag-verify diff 64K.svdag 256K.svdag -q && svdag-verify diff 256K.svdag 1M.svdag -q && echo nested
svdag build s.ply -r 64 --cube=-70,-70,-70,140 --bounds=-5,-5,-5,30,30,30 -q -o part.svdag && svdag info part.svdag | sed -n 2p
svdag plan s.ply -r 1K --cube=-70,-70,-70,140 --shards 2 -o plan -q && svdag run plan -q -j 1 && cmp plan/s.svdag 1K.svdag
# below 64K voxels may differ where a triangle is within the snap of a voxel plane; this scene has no such triangle
for r in 2K 4K 8K 16K 32K; do svdag build s.ply -r $r --cube=-70,-70,-70,140 -q -o $r.svdag; done
for p in "1K 2K" "2K 4K" "4K 8K" "8K 16K" "16K 32K" "32K 64K"; do set -- $p; svdag-verify diff $1.svdag $2.svdag -q && echo "$1 is half of $2"; done
svdag build s.ply -s 1 --cube=0,0,0,1 -o x.svdag || echo "exit $?"
svdag build s.ply -r 64 --cube=0,0,0 -o x.svdag || echo "exit $?"
svdag build s.ply -r 64 --cube=0,0,0,0 -o x.svdag || echo "exit $?"
