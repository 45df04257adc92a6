# --resume where no unfinished bake is: that the bake began anew is said, with the folder that was looked into.
svdag-scene speck -n 2K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag --resume | tail -1
mkdir elsewhere
svdag build a.ply -r 64 -o a.svdag --resume --scratch elsewhere | tail -1 | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
svdag build a.ply -r 64 -o a.svdag | grep resume || echo silent
