# An output may have the longest name that the file system allows; its scratch folder has a shorter one.
name=$(printf '%0249d' 0).svdag
svdag-scene scan -n 70K -q -o s.ply
svdag build s.ply -r 1K -o $name -q -m 8M --checkpoint 0.01
svdag build s.ply -r 1K -o s.svdag -q
cmp $name s.svdag
svdag build s.ply -r 1K -o $name --dry-run -q
svdag build s.ply -r 1K -o 0$name -q || echo "exit code $?"
ls
