# A plan stores its paths in JSON and rejects paths that JSON cannot represent.
latin=$(printf 'caf\351')
svdag-scene city -n 3K -q -o good.ply
cp good.ply "$latin.ply"
svdag plan "$latin.ply" -r 64 --shards 2 -o a.plan 2> answer || echo "exit $?"
svdag plan good.ply -r 64 --shards 2 -o "$latin.plan" 2>> answer || echo "exit $?"
grep -c 'is not valid UTF-8' answer
svdag build "$latin.ply" -r 64 -o dry.svdag --dry-run -q
svdag plan good.ply -r 64 --shards 2 -o good.plan -q
ls -d *.plan
mv good.plan "$latin.plan"
svdag submit "$latin.plan" --engine openjd -o openjd.json 2> answer || echo "exit $?"
grep -c 'is not valid UTF-8' answer
svdag run "$latin.plan" -q
