svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 256 -o city.svdag -q
for mode in primary shadow soft ao normal depth level steps; do
  svdag-verify render city.svdag -o $mode.png --mode $mode --size 40x30 --samples 4
done
for view in front back left right top inside; do
  svdag-verify render city.svdag -o $view.png --preset $view --size 40x30 -q --level 5
done
svdag-verify render city.svdag -o turn.png --size 20x15 --supersample 1 --fly 3
svdag-verify render city.svdag -o one.png --mode soft --size 40x30 -j 1 -q
svdag-verify render city.svdag -o two.png --mode soft --size 40x30 -j 2 -q
cmp one.png two.png
cmp -s front.png back.png && echo "all presets are one"
ls *.png | wc -l
