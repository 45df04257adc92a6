svdag-scene teapot -o t.ply
