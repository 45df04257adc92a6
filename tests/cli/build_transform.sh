# --transform, then --up, then --scale: recorded in the file, applied by the judge.
printf 'OFF\n4 2 0\n0 0 0\n4 0 0\n0 2 0\n0 0 1\n3 0 1 2\n3 0 2 3\n' > z.off
printf 'OFF\n4 2 0\n3 0 0\n15 0 0\n3 0 -6\n3 3 0\n3 0 1 2\n3 0 2 3\n' > y.off
svdag build z.off -r 64 --transform=1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1 --up z --scale 3 -q -o z.svdag
svdag build y.off -r 64 -q -o y.svdag
svdag-verify diff z.svdag y.svdag -q && echo same voxels
svdag info z.svdag | sed -n 2,4p
svdag info z.off --up z --scale 3 | sed -n 2p
svdag-verify mesh z.svdag z.off | grep '^grid\|^missing\|^extra\|^ok'
svdag-verify check z.svdag | tail -1
svdag plan z.off -r 64 --transform=1,0,0,1,0,1,0,0,0,0,1,0 --up z --scale 3 --shards 2 -o plan -q && svdag run plan -q -j 1 && cmp plan/z.svdag z.svdag
for up in x -x y -y z -z; do svdag build z.off -r 8 --up=$up -q -o up.svdag && svdag-verify mesh up.svdag z.off -q && echo "up $up"; done
# A unit of the scene.
svdag build z.off -s 5cm --units m -q -o s.svdag && svdag info s.svdag | sed -n 2p
svdag build z.off -s 5cm -o x.svdag || echo "exit $?"
svdag build z.off -s 5miles -o x.svdag || echo "exit $?"
svdag build z.off -s 5cm --units yard -o x.svdag || echo "exit $?"
svdag build z.off -r 8 --transform=1,2 -o x.svdag || echo "exit $?"
svdag build z.off -r 8 --transform=1,0,0,0,0,1,0,0,0,0,0,0 -o x.svdag || echo "exit $?"
svdag build z.off -r 8 --scale 0 -o x.svdag || echo "exit $?"
svdag build z.off -r 8 --up w -o x.svdag || echo "exit $?"
svdag info z.svdag --up z || echo "exit $?"
# Runs of differently placed scenes are not of one bake.
for part in 1/2 2/2; do svdag build z.off -s 0.5 --bounds=0,0,0,4,4,4 --part $part --scale ${part%/2} -q -o ${part%/2}.run; done
svdag merge 1.run 2.run -o x.svdag || echo "exit $?"
