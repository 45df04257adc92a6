#!/bin/sh
# make demo: generates a scene, bakes it at 16K, verifies and renders it, and writes an HTML report.
# Usage: demo.sh PROGRAMS FOLDER
set -eu
programs=$1
folder=$2
mkdir -p "$folder"
start=$(date +%s)
step() { printf '%4d s  %s\n' $(($(date +%s) - start)) "$1"; }

step "generate the atrium"
"$programs"/svdag-scene atrium -o "$folder"/atrium.glb
step "bake it at 16K, with its materials as layers, in the colours of its textures"
"$programs"/svdag build "$folder"/atrium.glb -r 16K --layers material --colours --colour-level 10 \
  -o "$folder"/atrium.svdag --report "$folder"/atrium.json
step "bake it at 1K"
"$programs"/svdag build "$folder"/atrium.glb -r 1K --layers material -o "$folder"/atrium-1k.svdag
step "check the file: checksums, pointers, order, minimality"
"$programs"/svdag-verify check "$folder"/atrium.svdag
step "voxelize independently and compare: every brick at 1K"
"$programs"/svdag-verify mesh "$folder"/atrium-1k.svdag "$folder"/atrium.glb
step "the same for a sample of 100,000 bricks at 16K"
"$programs"/svdag-verify mesh --sample 100000 "$folder"/atrium.svdag "$folder"/atrium.glb
step "render"
"$programs"/svdag-verify render "$folder"/atrium.svdag -o "$folder"/atrium.png -q \
  --mode soft --camera=-10.5,2.2,1.8,6,3.4,-1.2,75 --light=2,7.5,0,0.5 --size 800x420
step "report"
"$programs"/svdag-verify report "$folder"/atrium.svdag "$folder"/atrium.json -o "$folder"/atrium.html -q \
  --size 800x450
step "done: $folder/atrium.svdag, atrium.json, atrium.png; open $folder/atrium.html"
