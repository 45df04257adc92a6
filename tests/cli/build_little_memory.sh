svdag-scene hairball -n 1M -q -o h.ply
svdag build h.ply -r 1K -m 1M -o h.svdag
