# Unknown or unsupported vectors are rejected with a list of the supported ones.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag --vectors MMX
