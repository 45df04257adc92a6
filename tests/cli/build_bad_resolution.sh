svdag build r.ply -r 1000 -o r.svdag
