# A binvox file is the smallest cube of what is occupied, or of --bounds; an import has it in the same place.
printf 'v 0 0 0\nv 11 0 0\nv 11 7 0\nv 0 7 3\nf 1 2 3 4\n' > a.obj
svdag build a.obj -o a.svdag -s 1 --origin 0,0,0 -q
svdag info a.svdag | grep 'voxels,\|occupied'
svdag export a.svdag -o a.binvox && head -4 a.binvox | tail -3
svdag export a.svdag -o all.binvox --bounds=-99,-99,-99,99,99,99 -q && head -2 all.binvox | tail -1
svdag export a.svdag -o half.binvox --level 3 -q && head -4 half.binvox | tail -3
svdag import a.binvox -o back.svdag
svdag info back.svdag | grep occupied
echo '0.5 0.5 0.1' | svdag query a.svdag | cut -d' ' -f1
echo '0.5 0.5 0.1' | svdag query back.svdag | cut -d' ' -f1
