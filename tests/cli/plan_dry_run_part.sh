# What a part would take is not known without a plan: no prediction of the whole passes for it.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o x.run --part 1/2 --dry-run
