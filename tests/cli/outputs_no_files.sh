# An output that is a folder, a pipe or a device, or a link to one, is rejected before the work begins,
# and is not changed.
refused() { "$@" || echo "exit code $?"; }
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q --report r.json
svdag build r.ply -r 64 -o r.run -q --part 1/1
svdag export r.svdag -o r.npz -q
mkdir folder.svdag
mkfifo pipe.svdag pipe.npz pipe.png
ln -s /dev/null device.svdag
ln -s /proc/self/fd/1 stdout.svdag
for out in folder pipe device stdout; do refused svdag build r.ply -r 64 -o $out.svdag; done
refused svdag build r.ply -r 64 -o new.svdag --report pipe.svdag
refused svdag build r.ply -r 64 -o new.svdag --report nowhere/r.json
echo '[{"scene": "r.ply", "output": "new.svdag", "resolution": 64}]' >list.json
refused svdag build --batch list.json --report device.svdag
refused svdag build r.ply -r 64 -o pipe.svdag --dry-run
refused svdag merge r.run -o pipe.svdag
refused svdag export r.svdag -o pipe.npz
refused svdag import r.npz -o pipe.svdag
refused svdag-verify report r.svdag r.json -o pipe.svdag
refused svdag-verify render r.svdag -o pipe.png
refused svdag-verify diff r.svdag r.svdag --write-diff pipe.svdag
ls -F
# The output replaces a link to a file or to nothing; the target of the link is kept.
echo precious >file
ln -s file link.svdag
ln -s nothing dangling.svdag
svdag build r.ply -r 64 -o link.svdag -q
svdag build r.ply -r 64 -o dangling.svdag -q
cat file
cmp link.svdag r.svdag && cmp dangling.svdag r.svdag
ls -F
