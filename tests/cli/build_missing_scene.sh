svdag build missing.ply -r 64 -o r.svdag
