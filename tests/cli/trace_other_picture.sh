# A picture format that is not supported, and a light of nearly infinite size.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 16 -o a.svdag -q
svdag-trace a.svdag --picture a.png || echo "exit $?"
svdag-trace a.svdag --light 0,0,0,1e308 || echo "exit $?"
