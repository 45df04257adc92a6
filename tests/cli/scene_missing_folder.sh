svdag-scene city -n 120 -o missing/city.ply
