# -v prints what each phase did.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -v
