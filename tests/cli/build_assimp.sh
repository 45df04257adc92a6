# FBX, COLLADA, 3MF and 3DS give the voxels of the same scene as an OBJ, in the limited child process too.
python3 $TESTS/foreign_scenes.py s
svdag build s.obj -o s.svdag -r 256 -q
for name in s.dae s_z.dae s.fbx s_z.fbx s.3mf s.3ds; do
  svdag build $name -o a.svdag -r 256 -q && cmp s.svdag a.svdag
  svdag build $name --sandbox -o a.svdag -r 256 -q && cmp s.svdag a.svdag
  svdag info $name --parts | grep 'object:\|material:'
done
svdag build s.dae -o one.svdag -r 256 -q --include copy
svdag info one.svdag | grep occupied
svdag build s.fbx -o one.svdag -r 256 --exclude 'material:stone' || echo "exit $?"
gzip -k s.dae
svdag build s.dae.gz -o a.svdag -r 256 -q && cmp s.svdag a.svdag
svdag-verify mesh s.svdag s.3ds | tail -1
for name in s.dae s.fbx s.3mf s.3ds; do
  head -c 200 $name > short.${name#s.}
  svdag build short.${name#s.} -o b.svdag -r 64 -q 2>&1 | sed 's/file: .*/file: .../' 
done
# Truncated at any place, or with any byte replaced: triangles or an error, of a child that may have died.
python3 - <<'PY'
import pathlib, random, subprocess
random.seed(5)
codes = set()
for name in ("s.dae", "s.fbx", "s_z.fbx", "s.3mf", "s.3ds"):
    data = pathlib.Path(name).read_bytes()
    for i in range(24):
        at = random.randrange(len(data))
        hostile = data[:at] if i % 3 == 0 else data[:at] + bytes([random.choice((0, 255, 0x7f, 0x39))]) + data[at + 1:]
        path = pathlib.Path("hostile." + name.split(".")[1])
        path.write_bytes(hostile)
        done = subprocess.run(["svdag", "info", path, "--sandbox"][:3 + i % 2], capture_output=True, text=True)
        assert done.returncode in (0, 3), (name, i, done)
        assert done.returncode == 0 or done.stderr.startswith("svdag: hostile."), done
        codes.add(done.returncode)
print("exit codes", sorted(codes))
PY
