# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o a.svdag -q
echo old > dump.bin
ln dump.bin other.bin
svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --picture new.ppm > /dev/null
(ulimit -f 8; svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --dump dump.bin > /dev/null) || echo "exit $?"
cat dump.bin
svdag-trace a.svdag --size 64x64 --samples 1 --rounds 1 --dump dump.bin > /dev/null
cat other.bin
svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 --dump nowhere/dump.bin > /dev/null || echo "exit $?"
ls -A
