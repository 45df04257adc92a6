svdag-scene atrium -n 100 -o t.ply
