# `svdag export` is a program of its own, looked for beside svdag.
cp "$(command -v svdag)" svdag
./svdag export a.svdag -o a.vdb
