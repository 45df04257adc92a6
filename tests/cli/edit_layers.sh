# Edits keep layers: a crop is the bake with --bounds, set operations go by name, a file without layers is a mask.
svdag-scene atrium -q -o atrium.obj
cube='--cube=-17,-2,-10,34'
box='--bounds=-17,-2,-10,0.5,6,9'
svdag build atrium.obj -o a.svdag -r 128 $cube --layers material -q
svdag build atrium.obj -o baked.svdag -r 128 $cube --layers material -q $box
svdag edit a.svdag -o half.svdag $box
svdag info half.svdag --layers | tail -9 >half.txt
svdag info baked.svdag --layers | tail -9 | cmp - half.txt && svdag-verify diff half.svdag baked.svdag -q && echo "the crop is the bake"
svdag edit a.svdag half.svdag -o rest.svdag --difference
svdag edit rest.svdag half.svdag -o again.svdag --union -q && cmp again.svdag a.svdag && echo "both parts are all"
svdag edit again.svdag -o coarse.svdag --level 5 --layout compact && svdag info coarse.svdag --layers | tail -9
# Masks.
svdag build atrium.obj -o mask.svdag -r 128 $cube -q
svdag edit mask.svdag -o half_mask.svdag $box -q
svdag edit a.svdag half_mask.svdag -o b.svdag --intersection -q && svdag-verify diff b.svdag half.svdag -q && echo "the mask cuts every layer"
svdag edit a.svdag half_mask.svdag -o b.svdag --difference -q && svdag-verify diff b.svdag rest.svdag -q && echo "and takes from every layer"
svdag edit half_mask.svdag a.svdag -o b.svdag --intersection -q && cmp b.svdag half.svdag
svdag edit half_mask.svdag half.svdag -o b.svdag --difference
svdag edit half.svdag mask.svdag -o b.svdag --union && svdag info b.svdag --layers | grep unnamed
# One layer.
svdag edit a.svdag half.svdag -o b.svdag --difference --layer roof
svdag edit rest.svdag -o c.svdag --layer roof -q && svdag-verify diff b.svdag c.svdag -q
for f in half rest again coarse b; do svdag-verify check $f.svdag | tail -1; done
# Errors.
svdag build atrium.obj -o objects.svdag -r 128 $cube --layers object -q
svdag edit a.svdag objects.svdag -o x.svdag --union || echo "exit $?"
svdag build atrium.obj -o frames.svdag -r 128 $cube --layers material --no-union -q
svdag edit mask.svdag frames.svdag -o x.svdag --difference || echo "exit $?"
svdag edit mask.svdag half_mask.svdag -o x.svdag --union --layer roof || echo "exit $?"
svdag edit a.svdag half.svdag -o x.svdag --union --layer rof || echo "exit $?"
