#!/bin/sh
# make pictures: the rendered pictures of docs/images/, of a generated scene, in the manner of figure 4 of
# Kaempe, Sintorn and Assarsson 2013.
# Usage: pictures.sh PROGRAMS FOLDER
set -eu
programs=$1
folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs"/svdag-scene atrium -q -o "$work"/atrium.ply
"$programs"/svdag build "$work"/atrium.ply -r 8K -q -o "$work"/atrium.svdag
inside=-10.5,2.2,1.8,6,3.4,-1.2,75
for mode in soft ao level steps; do
  "$programs"/svdag-verify render "$work"/atrium.svdag -o "$folder"/atrium_$mode.png --mode $mode \
    --camera=$inside --light=2,7.5,0,0.5 --size 304x171 --samples 32 -q
done
