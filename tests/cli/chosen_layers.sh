# --layer, given more than once: the file of these layers, whose union is theirs.
printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\nv 0 0 8\nf 4 3 5\no floor\nf 1 2 3\no wall\nf 1 4 5\no roof\nf 3 4 5\nf 2 4 5\n' > a.obj
svdag build a.obj -o a.svdag -r 256 --layers object -q
svdag info a.svdag --layers | tail -4
svdag convert a.svdag -o two.svdag --layer wall --layer floor --layer wall
svdag-verify check two.svdag | tail -1
svdag info two.svdag --layers | tail -2
# The union is the OR.
for layer in wall floor; do svdag convert a.svdag -q -o $layer.svdag --layer $layer; done
svdag edit wall.svdag floor.svdag --union -q -o edited.svdag && svdag-verify diff two.svdag edited.svdag -q && echo "the union is the OR"
# One name, twice, is that layer alone. All names are the whole file.
svdag convert a.svdag -q -o again.svdag --layer wall --layer wall && cmp wall.svdag again.svdag
svdag convert a.svdag -q -o all.svdag --layer roof --layer floor --layer wall --layer '(unnamed)' && cmp a.svdag all.svdag
# Every form of a file, and the other programs.
svdag convert a.svdag -q -o compact.svdag --layout compact && svdag pack a.svdag -q -o a.pack
for file in compact.svdag a.pack; do svdag convert $file -q -o x.svdag --layer floor --layer wall && cmp x.svdag two.svdag; done
svdag convert a.svdag -q -o x.svdag --layer floor --layer wall --layout compact && svdag convert x.svdag -q -o y.svdag --layout plain && cmp y.svdag two.svdag
svdag export a.svdag -q -o x.npz --layer floor --layer wall && svdag export two.svdag -q -o y.npz && cmp x.npz y.npz
svdag export a.svdag --layer floor --layer wall --format hashdag -o x.basic_dag.dag.bin -q
svdag export edited.svdag --format hashdag -o y.basic_dag.dag.bin -q && cmp x.basic_dag.dag.bin y.basic_dag.dag.bin
svdag-verify render a.svdag -o x.png --layer wall --layer floor --size 64x36
svdag-verify render two.svdag -o y.png -q --size 64x36 && cmp x.png y.png
svdag-verify diff a.svdag two.svdag --layer wall --layer floor | tail -4
# The unnamed layer has the name that is shown, unless a layer has that very name.
svdag convert a.svdag -q -o unnamed.svdag --layer '(unnamed)' && svdag-verify check unnamed.svdag | sed -n 4p
printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 0 0 1\nf 1 2 3\no (unnamed)\nf 1 2 4\n' > b.obj
svdag build b.obj -o b.svdag -r 64 --layers object -q && svdag info b.svdag --layers | tail -2
svdag export b.svdag -o b.npz --layer '(unnamed)'
# Errors.
svdag convert a.svdag -o x.svdag --layer wall --layer flor || echo "exit $?"
svdag convert a.svdag -o x.svdag --layer '(unamed)' || echo "exit $?"
svdag convert a.svdag -o x.svdag --layer wall floor || echo "exit $?"
svdag convert edited.svdag -o x.svdag --layer '(unnamed)' --layer wall || echo "exit $?"
