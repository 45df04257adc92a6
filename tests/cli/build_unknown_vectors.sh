# Vectors that the processor lacks, or that nobody knows, are named with those there are.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag --vectors MMX
