# `svdag export` is a separate program in the folder of svdag.
cp "$(command -v svdag)" svdag
./svdag export a.svdag -o a.vdb
