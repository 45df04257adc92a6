# Voxels of any size and position are imported from a .vdb with exactly the same grid.
grid_of() { svdag info --json "$1" | sed -n '/"corner"/,/]/p; /"voxel_size"/p'; }
printf 'v 0.1 0.2 0.3\nv 0.10001 0.20003 0.3\nv 0.10002 0.2 0.30004\nf 1 2 3\n' > tiny.obj
printf 'v 1841111.4 5176075.3 191.1\nv 1841111.41 5176075.31 191.1\nv 1841111.4 5176075.31 191.12\nf 1 2 3\n' > far.obj
svdag build tiny.obj -s 1e-6 -o tiny.svdag -q
svdag build tiny.obj -r 64 -o box.svdag -q
svdag build far.obj -s 0.0003 -o far.svdag -q
svdag build far.obj -r 64 -o farbox.svdag -q
for name in tiny box far farbox; do
  for type in bool mask; do
    svdag export $name.svdag -o $name.vdb -q --vdb-type $type
    svdag import $name.vdb -o back.svdag -q
    grid_of $name.svdag > before
    grid_of back.svdag > after
    cmp before after
    svdag-verify diff $name.svdag back.svdag -q
    svdag-verify vdb $name.svdag $name.vdb -q
  done
  svdag export $name.svdag -o $name.nvdb
done
cat before
