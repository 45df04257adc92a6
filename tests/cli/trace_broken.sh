svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 -o city.svdag -q
# A pointer of the first node of the deepest inner level.
section=$(od -An -tu8 -j 248 -N 8 city.svdag)
printf '\377\377\377\177' | dd of=city.svdag bs=1 seek=$((section + 4)) conv=notrunc 2>/dev/null
svdag-trace city.svdag
