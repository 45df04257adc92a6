# A file that was baked from another scene differs: exit code 1.
svdag-scene city -n 1.2K --seed 1 -q -o one.ply
svdag-scene city -n 1.2K --seed 2 -q -o two.ply
svdag build one.ply -r 64 -o one.svdag -q
svdag-verify mesh one.svdag two.ply
