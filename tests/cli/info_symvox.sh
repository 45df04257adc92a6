# A SymVox .svdag is distinguished from this project's, which has a magic number.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 256 -o r.svdag -q
svdag export r.svdag --format symvox -o other.svdag -q
svdag info other.svdag || echo "exit $?"
svdag-verify check other.svdag || echo "exit $?"
svdag-verify diff other.svdag r.svdag || echo "exit $?"
svdag export other.svdag -o x.vox || echo "exit $?"
head -c 40 other.svdag > cut.svdag
svdag-verify check cut.svdag || echo "exit $?"
svdag import other.svdag -o back.svdag -q
svdag-verify diff back.svdag r.svdag
