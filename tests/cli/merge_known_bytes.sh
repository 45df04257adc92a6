# Known hashes of runs: detects a change of the format.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 128 -o box.run -q
svdag build r.ply -s 0.75 --part 2/3 -o lattice.run -q
sha256sum box.run lattice.run
