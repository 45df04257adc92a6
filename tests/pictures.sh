#!/bin/sh
# make pictures: renders the pictures of docs/images/ from generated scenes. The modes follow figure 4 of Kaempe,
# Sintorn and Assarsson 2013.
# Usage: pictures.sh PROGRAMS FOLDER
set -eu
programs=$1
folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# bake SCENE GRID ENDING OPTIONS...; render NAME SCENE OPTIONS...
bake() {
  scene=$1 grid=$2 ending=$3
  shift 3
  "$programs"/svdag-scene "$scene" -q -o "$work"/"$scene"."$ending"
  "$programs"/svdag build "$work"/"$scene"."$ending" -r "$grid" -q -o "$work"/"$scene".svdag "$@"
}
render() {
  name=$1 scene=$2
  shift 2
  "$programs"/svdag-verify render "$work"/"$scene".svdag -o "$folder"/"$name".png "$@" -q
}
# join NAME PICTURES...: one picture with a palette
join() {
  name=$1
  shift
  /usr/bin/python3 -B "$(dirname "$0")"/join_pictures.py "$folder"/"$name".png "$@"
}

inside=-10.5,2.2,1.8,6,3.4,-1.2,75
light=2,7.5,0,0.5
bake atrium 16K glb --colours --colour-level 11
render atrium atrium --mode soft --camera=$inside --light=$light --size 800x420  # as tests/demo.sh, but finer colours
join atrium "$folder"/atrium.png
bake atrium 8K obj --layers material
for mode in level steps; do
  render atrium_$mode atrium --mode $mode --camera=$inside --light=$light --size 304x171 --samples 32
done
/usr/bin/python3 -B "$(dirname "$0")"/view/picture.py "$programs" "$work"/atrium.svdag "$folder"/viewer.png
bake figure 512 glb --frames 0:0.875:0.125
"$programs"/svdag-verify render "$work"/figure.svdag --frames -o "$work"/walk.png -q --mode soft \
  --camera=2.6,1.25,2.6,0,0.87,0.05,31 --light=3,6,2,1 --size 125x250
join walk "$work"/walk_000?.png
bake scan 4K obj
render scan scan --mode soft --camera=-95,45,110,-4,4,-3,48 --light=-150,220,60,20 --size 400x300
bake scan 1K obj --rule solid
render solid scan --mode soft --slice z=10 --camera=-60,45,175,-4,5,-3,40 --light=-150,220,160,20 --size 400x300
bake hairball 2K obj
render hairball hairball --mode soft --camera=-75,50,95,0,0,0,44 --light=-120,160,120,20 --size 400x300

# The two rules in two dimensions.
/usr/bin/python3 -B "$(dirname "$0")"/rules_picture.py "$folder"/rules.svg
