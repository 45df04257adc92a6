# The next bake of an output removes the scratch folder of a killed dry run, but no other and none in use.
svdag-scene speck -n 100 -q -o s.ply
mkdir elsewhere
left() { mkdir -p -m 700 $1; touch $1/owner; echo spilled > $1/passing; }

left s.svdag.dry-run.scratch
svdag build s.ply -r 64 -o s.svdag -q
left s.svdag.dry-run.scratch
svdag build s.ply -r 64 -o s.svdag -q --dry-run
echo '[{"scene": "s.ply", "output": "s.svdag", "resolution": 64}]' > list.json
left s.svdag.dry-run.scratch
svdag build --batch list.json -q
find . -name '*.scratch'

# With --scratch the folder has the name that the dry run chose.
svdag-scene scan -n 70K -q -o scan.ply
svdag build scan.ply -r 8K -o scan.svdag -q -m 8M --dry-run --scratch elsewhere &
until test -n "$(find elsewhere -name owner)"; do sleep 0.02; done
kill -s KILL $!
wait $! 2>/dev/null || true
find elsewhere -name '*.scratch' | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
svdag build scan.ply -r 64 -o scan.svdag -q --scratch elsewhere
find elsewhere -name '*.scratch'

left s.svdag.dry-run.scratch
flock s.svdag.dry-run.scratch/owner svdag build s.ply -r 64 -o s.svdag -q
ls s.svdag.dry-run.scratch
rm s.svdag.dry-run.scratch/owner
svdag build s.ply -r 64 -o s.svdag -q
ls s.svdag.dry-run.scratch
left s.svdag.dry-run.scratch
touch s.svdag.dry-run.scratch/journal
svdag build s.ply -r 64 -o s.svdag -q
ls s.svdag.dry-run.scratch
