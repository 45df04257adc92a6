echo "hello, this is no mesh" > notes.txt
svdag build notes.txt -r 64 -o r.svdag
