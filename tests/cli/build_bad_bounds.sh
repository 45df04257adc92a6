svdag build r.ply -r 64 --bounds=1,1,1,0,0,0 -o r.svdag
