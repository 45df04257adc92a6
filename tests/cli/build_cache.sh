# A second bake takes every cell from the cache; another rule takes none.
svdag-scene city -n 6K -q -o city.ply
svdag build city.ply -r 1K -q -o plain.svdag
for name in first second; do
  svdag build city.ply -r 1K -v -o $name.svdag --cache cells | grep cells
  cmp plain.svdag $name.svdag
done
svdag build city.ply -r 1K --rule thin -v -o thin.svdag --cache cells | grep cells
svdag build city.ply -r 1K -q -o x.svdag --cache-size 1G || echo "exit $?"
