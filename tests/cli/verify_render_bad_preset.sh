svdag-scene speck -n 8 -q -o a.ply
svdag build a.ply -r 16 -o a.svdag -q
svdag-verify render a.svdag -o a.png --preset below
