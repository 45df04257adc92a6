svdag-scene city -n many -o t.ply
