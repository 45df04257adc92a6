svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 3 -o p -q
svdag submit p --engine openjd --program svdag -o t.json
sed 's/"min": [0-9]*/"min": N/' t.json
