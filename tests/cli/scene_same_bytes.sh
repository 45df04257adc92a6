# One known hash per kind: compilers and flags do not affect the bytes.
svdag-scene atrium -n 100K -q -o atrium.ply
svdag-scene hairball -n 10K -q -o hairball.ply
svdag-scene scan -n 10K -q -o scan.ply
svdag-scene city -n 10K -q --yaw 30 -o city.ply
svdag-scene terrain -n 10K -q --double -o terrain.ply
svdag-scene terrain -n 10K -q --shuffle --seed 7 -o shuffled.ply
svdag-scene sheet -q -o sheet.ply
sha256sum *.ply
