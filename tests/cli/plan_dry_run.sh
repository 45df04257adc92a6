svdag-scene city -n 5K -q -o c.ply
svdag build c.ply -r 512 -o c.svdag --dry-run -j 1 -m 200M
ls
