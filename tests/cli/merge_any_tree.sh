# Parts baked separately, with other threads and memory, merged in any tree, equal the bake of the whole.
svdag-scene city -n 6K --yaw 30 -q -o c.ply
svdag build c.ply -r 256 -o whole.svdag -q
svdag build c.ply -r 256 -o whole.run -q
for i in 1 2 3 4 5; do svdag build c.ply -r 256 --part $i/5 -o $i.run -j $i -m $((i * 40))M -q; done
svdag merge 4.run 2.run -o a.run
svdag merge 5.run a.run 1.run -o b.run -q -m 8M
svdag merge b.run 3.run -o merged.svdag
svdag merge 3.run b.run -o merged.run -q -j 1
cmp whole.svdag merged.svdag
cmp whole.run merged.run
svdag-verify mesh merged.svdag c.ply
