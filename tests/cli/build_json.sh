# --json prints the report instead of the summary; with --dry-run, the prediction.
svdag-scene speck -n 100 -q -o s.ply
svdag build s.ply -r 64 -o a.svdag --json --report r.json > out.json
cmp out.json r.json
svdag build s.ply -r 64 -o b.svdag --json --dry-run | python3 -c 'import json, sys; print(sorted(json.load(sys.stdin)))'
svdag build --batch list.json --dry-run --json || echo "exit $?"
ls
