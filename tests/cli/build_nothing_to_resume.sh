# --resume without an unfinished bake: reports that the bake began anew, with the folder that was checked.
svdag-scene speck -n 2K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag --resume | tail -1
mkdir elsewhere
svdag build a.ply -r 64 -o a.svdag --resume --scratch elsewhere | tail -1 | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
svdag build a.ply -r 64 -o a.svdag | grep resume || echo silent
