svdag-scene hairball -n 2K --yaw nan -o t.ply
