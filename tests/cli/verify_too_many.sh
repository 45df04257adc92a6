# Numbers of rays and draws that would take too long are rejected; draws are counted as memory.
printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\n' > a.obj
svdag build a.obj -r 64 -o a.svdag -q
for count in 18446744073709551615 1025G; do
  svdag-verify trace a.svdag a.obj --rays $count || echo "exit $?"
  svdag-verify mesh a.svdag a.obj --sample $count || echo "exit $?"
  svdag-verify mesh a.svdag a.obj --sample $count --judge openvdb || echo "exit $?"
done
svdag-verify mesh a.svdag a.obj --sample 1T -m 64M || echo "exit $?"
svdag-verify mesh a.svdag a.obj --sample 1T -m 64M --judge openvdb || echo "exit $?"
