# Names that are not valid UTF-8 do not fail a bake: in JSON the invalid bytes are replaced.
latin=$(printf 'caf\351')
svdag-scene city -n 3K -q -o good.ply
cp good.ply "$latin.ply"
printf 'v 0 0 \377\376\nf 1 2 3\n' > bad.obj
cat > list.json <<'LIST'
[{"scene": "bad.obj", "output": "bad.svdag", "resolution": 64},
 {"scene": "good.ply", "output": "good.svdag", "resolution": 64}]
LIST
svdag build --batch list.json --keep-going --report batch.json -q 2> /dev/null || echo "exit $?"
grep '"exit"\|"error"\|"bakes"' batch.json
svdag build "$latin.ply" -r 64 -o "$latin.svdag" --report report.json -q
grep -A 1 '"scene"\|"name"' report.json
svdag info --json "$latin.ply" | grep -A 1 '"scene"'
svdag-verify check --json "$latin.svdag" | grep -o '"file":"[^"]*"'
svdag-verify diff --json "$latin.svdag" good.svdag | grep -o '"a":"[^"]*"\|"same":[a-z]*'
svdag-verify mesh --json "$latin.svdag" good.ply | grep -o '"file":"[^"]*"'
svdag-verify trace --json "$latin.svdag" good.ply --rays 100 | grep -o '"file":"[^"]*"'
