#!/bin/bash
# Tests that scenes and bakes have the same bytes with every compiler and set of flags.
#
# Usage: one_hash.sh                  builds the programs with every combination
#        one_hash.sh small PROGRAMS   compares existing programs (as `make build` makes them)
#                                     with one build without any optimisation
# Bakes five scenes for both rules with each and compares the SHA-256 of scenes and results.
set -euo pipefail
shopt -s inherit_errexit  # a failed bake ends $(...) too
cd "$(dirname "$0")/../.."
root=$PWD/build/one-hash
mkdir -p "$root"

hashes_of() {  # PROGRAMS WORK-FOLDER
  local scene rule
  for scene in "atrium -n 100K" "hairball -n 100K" "scan -n 100K --double" "city -n 12K --yaw 30" "rectangle -n 2"; do
    # shellcheck disable=SC2086
    "$1"/svdag-scene $scene -q -o "$2"/scene.ply
    for rule in conservative thin; do
      rm -f "$2"/scene.svdag
      "$1"/svdag build "$2"/scene.ply -r "$resolution" --rule "$rule" -q -o "$2"/scene.svdag
      cat "$2"/scene.ply "$2"/scene.svdag | sha256sum | cut -c 1-12 | tr '\n' ' '
    done
  done
}

compile() {  # COMPILER FLAGS FOLDER
  cmake -S . -B "$3" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$1" \
    -DCMAKE_CXX_FLAGS="$2" -DSVDAG_ASSIMP=OFF -DSVDAG_UFBX=OFF -DSVDAG_3MF=OFF -DSVDAG_DRACO=OFF -DSVDAG_MESHOPT=OFF -DSVDAG_OPENMESH=OFF >/dev/null
  ninja -C "$3" svdag svdag-scene >/dev/null
}

combinations=("g++ -O0" "g++ -O2" "g++ -O3" "g++ -O3 -mfma" "g++ -O3 -mavx2" "g++ -O3 -mavx2 -mfma"
  "clang++ -O2" "clang++ -O3 -mfma")
resolution=1K
expected=
if [ "${1:-}" = small ]; then
  combinations=("g++ -O0")
  resolution=256
  expected=$(hashes_of "$2" "$root")
  echo "$2: $expected"
fi
for combination in "${combinations[@]}"; do
  compiler=${combination%% *}
  flags=${combination#* }
  case $flags in
    *-mavx2* | *-mfma*) grep -qw fma /proc/cpuinfo || { echo "$combination: not on this processor"; continue; } ;;
  esac
  folder=$root/$(echo "$combination" | tr -c 'a-z0-9\n' _)
  compile "$compiler" "$flags" "$folder"
  hashes=$(hashes_of "$folder" "$folder")
  echo "$combination: $hashes"
  : "${expected:=$hashes}"
  [ "$hashes" = "$expected" ] || { echo "$combination: the bytes differ from those of ${2:-${combinations[0]}}"; exit 1; }
done
