# Known hashes of two bakes: detects a change of the format or of a voxel decision.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 128 -o box.svdag -q
svdag build r.ply -s 0.75 -o lattice.svdag -q
sha256sum box.svdag lattice.svdag
