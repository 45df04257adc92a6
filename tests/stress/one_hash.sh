#!/bin/bash
# One scene, one file: whatever the compiler and its flags, the same bytes.
# Bakes five scenes with every combination and compares the SHA-256 of the results.
set -euo pipefail
cd "$(dirname "$0")/../.."
root=$PWD/build/one-hash
mkdir -p "$root"

combinations=("g++ -O0" "g++ -O2" "g++ -O3" "g++ -O3 -mfma" "g++ -O3 -mavx2" "g++ -O3 -mavx2 -mfma"
  "clang++ -O2" "clang++ -O3 -mfma")
expected=
for combination in "${combinations[@]}"; do
  compiler=${combination%% *}
  flags=${combination#* }
  case $flags in
    *-mavx2* | *-mfma*) grep -qw fma /proc/cpuinfo || { echo "$combination: not on this processor"; continue; } ;;
  esac
  folder=$root/$(echo "$combination" | tr -c 'a-z0-9\n' _)
  cmake -S . -B "$folder" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_CXX_FLAGS="$flags" -DSVDAG_DRACO=OFF -DSVDAG_OPENMESH=OFF >/dev/null
  ninja -C "$folder" svdag svdag-scene >/dev/null
  hashes=
  for scene in "atrium -n 100K" "hairball -n 100K" "scan -n 100K --double" "city -n 12K --yaw 30" "rectangle -n 2"; do
    # shellcheck disable=SC2086
    "$folder"/svdag-scene $scene -q -o "$folder"/scene.ply
    "$folder"/svdag build "$folder"/scene.ply -r 1K -q -o "$folder"/scene.svdag
    hashes+="$(cat "$folder"/scene.ply "$folder"/scene.svdag | sha256sum | cut -c 1-16) "
  done
  echo "$combination: $hashes"
  : "${expected:=$hashes}"
  [ "$hashes" = "$expected" ] || { echo "The bytes differ from those of ${combinations[0]}."; exit 1; }
done
