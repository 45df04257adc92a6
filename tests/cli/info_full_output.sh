# A full output device is an error, for output of any length and every program.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag-scene hairball -n 2K -q -o h.ply
svdag build h.ply -r 64 -o h.svdag -q
for words in "svdag info r.ply" "svdag --version" "svdag-verify --version" "svdag-verify --help" "svdag-scene --version" \
    "svdag-trace --version" "svdag help grid" "svdag --manual-table" "svdag-export --version" "svdag-import --help" \
    "svdag-verify diff r.svdag h.svdag --by-index --show 100000 --json"; do
  $words > /dev/full 2> message && echo "not refused: $words" || echo "exit $?"
  cat message
done
svdag --version >&- 2> message || echo "exit $?"
cat message
