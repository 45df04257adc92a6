# One damaged byte is detected, and its position is reported.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
printf 'X' | dd of=r.svdag bs=1 seek=1100 conv=notrunc 2>/dev/null
svdag info r.svdag
