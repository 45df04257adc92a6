# The report of an interrupted batch contains the finished bakes.
svdag-scene scan -n 70K -q -o s.ply
echo '[{"scene": "s.ply", "output": "a.svdag", "resolution": "64"},
       {"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M"}]' > l.json
env --default-signal=INT svdag build --batch l.json --report r.json -q &  # background jobs of a shell ignore SIGINT
until ls z.svdag.scratch/journal >/dev/null 2>&1; do sleep 0.02; done
sleep 0.1
kill -s INT $!
wait $! || echo "exit $?"
/usr/bin/python3 -c "
import json
report = json.load(open('r.json'))
print(report['bakes'], [(each['output'], each['exit'], len(each['report']['content_hash'])) for each in report['done']])"
