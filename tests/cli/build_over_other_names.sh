# No output overwrites an input or another output, under any name of the file.
svdag-scene rectangle -q -o h.ply
svdag-scene rectangle -q -o h2.ply
cp h2.ply kept.ply
mkdir sub
refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
list() { echo "[$1]" > l.json; cp l.json l.kept; refused svdag build --batch l.json $2; cmp l.json l.kept; }
A='"scene": "h.ply", "resolution": 64, "output": "a.svdag"'
refused svdag build h.ply -r 64 -o x.svdag --report ./x.svdag
refused svdag build h.ply -r 64 -o x.svdag --report sub/../h.ply
refused svdag build h.ply -r 64 -o ''
list "{$A}" '--report l.json'
list "{$A}" '--report ./a.svdag'
list "{$A}, {\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"./a.svdag\"}"
list "{\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"h2.ply\"}, {\"scene\": \"h2.ply\", \"resolution\": 64, \"output\": \"b.svdag\"}"
list "{$A, \"report\": \"r.json\"}, {\"scene\": \"h.ply\", \"resolution\": 64, \"output\": \"b.svdag\", \"report\": \"./r.json\"}"
list "{$A, \"report\": \"l.json\"}"
list '{"scene": "h.ply", "resolution": 64, "output": ""}'
cmp h.ply h2.ply
cmp h2.ply kept.ply
# Existing outputs may be links to each other: each name gets its own file.
svdag build h.ply -r 64 -o one.svdag -q
cp one.svdag a.svdag
ln a.svdag b.svdag
ln -s a.svdag c.svdag
echo "[{$A}, {\"scene\": \"h.ply\", \"resolution\": 32, \"output\": \"b.svdag\"}, {\"scene\": \"h.ply\", \"resolution\": 16, \"output\": \"c.svdag\"}]" > links.json
svdag build --batch links.json -q
cmp one.svdag a.svdag
stat -c '%n %h %F' a.svdag b.svdag c.svdag
ls
