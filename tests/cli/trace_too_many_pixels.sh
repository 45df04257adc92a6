# More results than fit in half of the memory are rejected before tracing (on a machine of 80 GB there is room).
[ "$(getconf _PHYS_PAGES)" -gt 20000000 ] && cat "$(dirname "$0")/trace_too_many_pixels.stderr" >&2 && exit 5
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 16 -o a.svdag -q
svdag-trace a.svdag --size 16384x16384 --samples 1 --rounds 1 --dump d.bin
