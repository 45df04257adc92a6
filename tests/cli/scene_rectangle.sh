# The generator gives the same file on every machine.
svdag-scene rectangle -o r.ply
sha256sum r.ply
