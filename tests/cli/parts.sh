# --include and --exclude match objects, materials and files; a kind before a colon chooses one.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\no wall\nusemtl brick red\nf 1 2 3\nusemtl glass\nf 1 2 4\no brick oven\nf 2 3 4\n' > house.obj
svdag info house.obj --parts | sed -n '/object/,$p'
count() { svdag info house.obj "$@" | head -1; }
count --include 'brick*'
count --include 'material:brick*'
count --include 'object:brick*'
count --exclude glass
count --include wall --exclude 'material:glass'
count --include 'file:house*'
# A pattern that matches nothing is a mistake.
svdag build house.obj -r 8 --include 'windwo*' --include glass -o x.svdag || echo "exit $?"
svdag build house.obj -r 8 --exclude 'material:brik*' -o x.svdag || echo "exit $?"
svdag build house.obj -r 8 --exclude 'object:glass' -o x.svdag || echo "exit $?"
svdag build house.obj -r 8 --exclude 'windwo*' --allow-empty -q -o x.svdag && svdag-verify mesh x.svdag house.obj --exclude 'windwo*' --allow-empty -q && echo baked
svdag info house.obj --parts --json | grep -c kind
