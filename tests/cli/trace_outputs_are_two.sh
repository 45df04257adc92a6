# Two outputs must be two files, under any names, even if neither exists.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o a.svdag -q
mkdir folder
ln -s folder link
trace() { svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 "$@" > traced 2>&1 || { echo "exit $?"; cat traced; }; }
trace --dump x --picture x
trace --dump x --picture ./x
trace --dump "$PWD/x" --picture folder/../x
trace --dump folder/x --picture link/x
ls . folder
# The same for outputs that exist under another name.
touch here
ln here there
trace --dump here --picture there
trace --dump folder/x --picture x
ls . folder
