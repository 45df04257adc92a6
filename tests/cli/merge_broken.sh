svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.run -q
printf X | dd of=r.run bs=1 seek=1100 conv=notrunc status=none
echo old > out.svdag
svdag merge r.run -o out.svdag || code=$?
cat out.svdag
ls
exit $code
