svdag-scene city -n 1.2K -q -o city.ply
svdag info city.ply
