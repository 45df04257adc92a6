# Resolutions of one --cube nest exactly from 64K on (conservative): the parents of the finer grid are the coarser one.
# Below, at most the voxels within the snap of a plane differ; in this scene none does.
python3 - <<'PY'
import random
random.seed(16)
with open("soup.obj", "w") as file:
    for i in range(60):
        centre = [random.random() for _ in range(3)]
        size = 10 ** random.uniform(-5, -2)
        for _ in range(3):
            file.write("v %.17g %.17g %.17g\n" % tuple(c + random.uniform(-size, size) for c in centre))
        file.write("f -3 -2 -1\n")
PY
for pair in "1K 2K 10" "8K 16K 13" "32K 64K 15" "64K 128K 16" "128K 256K 17" "256K 512K 18" "512K 1M 19"; do
  set -- $pair
  svdag build soup.obj -o coarse.svdag -r $1 --cube=-0.1,-0.1,-0.1,1.3 -q
  svdag build soup.obj -o fine.svdag -r $2 --cube=-0.1,-0.1,-0.1,1.3 -q
  svdag edit fine.svdag -o parents.svdag --level $3 -q
  svdag-verify diff coarse.svdag parents.svdag > difference || true
  echo "$1 and $2: $(tail -1 difference)"
done
