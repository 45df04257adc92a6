echo "hello, this is not a mesh" > notes.txt
svdag build notes.txt -r 64 -o r.svdag
