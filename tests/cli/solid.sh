# Rule solid: closed surfaces are filled; every way of baking gives the same bytes.
cat > box.obj <<END
o box
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
END
svdag build box.obj -o box.svdag -r 64 --rule solid | sed 's/, [0-9.]* s$//'
svdag info box.svdag | head -1
svdag-verify check box.svdag | tail -1
svdag-verify mesh box.svdag box.obj | tail -3
svdag-verify mesh box.svdag box.obj --sample 100 | grep anywhere
svdag-verify mesh box.svdag box.obj --judge cgal -q
svdag-verify trace box.svdag box.obj --rays 10000 -q
svdag-scene scan -n 20K -q -o scan.ply
svdag build scan.ply -o scan.svdag -r 256 --rule solid -q
svdag-verify mesh scan.svdag scan.ply | tail -1
svdag build scan.ply -o small.svdag -r 256 --rule solid -q -m 8M && cmp scan.svdag small.svdag
for i in 1 2 3; do svdag build scan.ply -o "$i.run" -r 256 --rule solid -q --part "$i/3"; done
svdag merge 3.run 1.run 2.run -q -o merged.svdag && cmp scan.svdag merged.svdag
svdag plan scan.ply -o scan.plan -r 256 --rule solid --shards 2 -q && svdag run scan.plan -q && cmp scan.svdag scan.plan/*.svdag
for i in 1 2; do svdag build scan.ply -o cached.svdag -r 256 --rule solid -q --cache cells && cmp scan.svdag cached.svdag; done
# What is not closed.
sed '$d' box.obj > open.obj
svdag build open.obj -o open.svdag -r 64 --rule solid || echo "exit $?"
svdag build open.obj -o open.svdag -r 64 --rule solid --open surface | sed 's/, [0-9.]* s$//'
svdag-verify mesh open.svdag open.obj -q
sed 's/f 1 4 3 2/f 1 2 3 4/' box.obj > turned.obj
svdag build turned.obj -o turned.svdag -r 64 --rule solid || echo "exit $?"
svdag build turned.obj -o turned.svdag -r 64 --rule solid --inside odd | sed 's/, [0-9.]* s$//'
svdag info turned.obj | tail -2
svdag-verify diff box.svdag turned.svdag || echo "exit $?"
# A scene too small for a grid is neither closed nor open.
printf 'v 0 0 0\nv 1e-310 0 0\nv 0 1e-310 0\nf 1 2 3\n' > tiny.obj
svdag info tiny.obj | tail -1
# What cannot be.
svdag build box.obj -o x.svdag -r 64 --rule full || echo "exit $?"
svdag build box.obj -o x.svdag -r 64 --inside odd || echo "exit $?"
svdag build box.obj -o x.svdag -r 64 --rule solid --inside all || echo "exit $?"
svdag build box.obj -o x.svdag -r 64 --rule solid --open ignore || echo "exit $?"
svdag-verify mesh box.svdag box.obj --judge openvdb || echo "exit $?"
svdag build box.obj -o x.svdag -r 64 --open surface || echo "exit $?"
# Layers: two boxes, one in the other; the wall of a third is open.
svdag-scene atrium -q -o atrium.obj
svdag build atrium.obj -o a.svdag -r 256 --rule solid --layers object --open surface -q && svdag-verify check a.svdag | tail -1
svdag-verify mesh a.svdag atrium.obj | tail -1
svdag build scan.ply box.obj -o two.svdag -r 128 --rule solid --layers file | sed 's/, [0-9.]* s$//'
svdag info two.svdag --layers | tail -3
svdag-verify mesh two.svdag scan.ply box.obj | tail -3
svdag build scan.ply box.obj -o small.svdag -r 128 --rule solid --layers file -m 8M -q && cmp two.svdag small.svdag
svdag build scan.ply open.obj -o mixed.svdag -r 128 --rule solid --open surface --layers file | sed 's/, [0-9.]* s$//'
svdag-verify mesh mixed.svdag scan.ply open.obj | tail -3
svdag-verify mesh mixed.svdag scan.ply open.obj --sample 100 | tail -1
