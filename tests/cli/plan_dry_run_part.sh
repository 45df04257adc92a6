# The cost of a part is not known without a plan: the prediction of the whole is not reported for it.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o x.run --part 1/2 --dry-run
