# Union, intersection, difference, crop and a coarser level: the same bytes as a bake of these voxels.
svdag-scene speck -n 300 -q -o a.ply
printf 'OFF\n3 1 0\n-60 -50 -40\n60 40 30\n0 60 -60\n3 0 1 2\n' > b.off
cube='--cube=-70,-70,-70,140'
for s in a.ply b.off; do svdag build $s -r 256 $cube -q -o ${s%.*}.svdag; done
svdag build a.ply b.off -r 256 $cube -q -o ab.svdag
svdag edit a.svdag b.svdag -o union.svdag --union && cmp union.svdag ab.svdag && echo "the union is the bake of both"
svdag edit ab.svdag b.svdag -o rest.svdag --difference -q && svdag edit a.svdag b.svdag -o common.svdag --intersection -q
svdag edit a.svdag common.svdag -o a_only.svdag --difference -q
svdag-verify diff rest.svdag a_only.svdag -q && echo "(a or b) without b is a without (a and b)"
svdag edit rest.svdag common.svdag -o again.svdag --union -q && svdag-verify diff again.svdag a.svdag -q && echo "both parts are a"
box='--bounds=-33.3,-20,-5,21,40.4,52'
svdag build a.ply b.off -r 256 $cube $box -q -o baked.svdag
svdag edit ab.svdag -o cropped.svdag $box -q && svdag-verify diff cropped.svdag baked.svdag -q && echo "the crop is the bake with --bounds"
svdag edit a.svdag b.svdag -o both.svdag --union $box -q && cmp both.svdag cropped.svdag
svdag edit ab.svdag -o coarse.svdag --level 6 && svdag-verify diff coarse.svdag ab.svdag -q && echo "the level is the same scene"
svdag build a.ply b.off -r 64 $cube -q -o 64.svdag && svdag-verify diff 64.svdag coarse.svdag -q && echo "and the same voxels"
svdag edit a.svdag a.svdag -o none.svdag --difference | head -1
for f in union rest common cropped coarse none; do svdag-verify check $f.svdag | tail -1; done
# What makes no sense is refused.
svdag edit a.svdag -o x.svdag || echo "exit $?"
svdag edit a.svdag b.svdag -o x.svdag || echo "exit $?"
svdag edit a.svdag -o x.svdag --union || echo "exit $?"
svdag edit a.svdag b.svdag -o x.svdag --union --difference || echo "exit $?"
svdag edit a.svdag 64.svdag -o x.svdag --union || echo "exit $?"
svdag build b.off -r 256 --cube=-70,-70,-70,141 -q -o c.svdag; svdag edit a.svdag c.svdag -o x.svdag --union || echo "exit $?"
svdag build b.off -r 256 $cube --rule thin -q -o t.svdag; svdag edit a.svdag t.svdag -o x.svdag --union || echo "exit $?"
svdag edit a.svdag -o x.svdag --level 9 || echo "exit $?"
svdag edit a.svdag -o x.svdag --bounds=900,0,0,901,1,1 || echo "exit $?"
svdag edit a.svdag -o a.svdag --level 5 || echo "exit $?"
svdag edit a.svdag -o a.vdb --level 5 || echo "exit $?"
svdag edit a.svdag b.svdag -o union.svdag --union -n || echo "exit $?"
