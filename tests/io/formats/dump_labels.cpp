// Prints the grid `layer` of a .vdb, read by OpenVDB itself: its metadata, then the boxes of its
// active values, as x0 y0 z0 side label.
#include <cstdio>

#include "io/formats/vdb/vdb_trees.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  openvdb::initialize();
  openvdb::io::File file(argv[1]);
  file.open(/*delayLoad=*/false);
  for (auto name = file.beginName(); name != file.endName(); ++name)
    std::printf("grid %s\n", name.gridName().c_str());
  const auto grid = openvdb::gridPtrCast<openvdb::Int32Grid>(file.readGrid("layer"));
  if (!grid) return 1;
  for (auto entry = grid->beginMeta(); entry != grid->endMeta(); ++entry)
    std::printf("%s=%s\n", entry->first.c_str(), entry->second->str().c_str());
  std::printf("background %d, leaves %zu\n", grid->background(), size_t(grid->tree().leafCount()));
  const svdag::IndexToWorld centres = svdag::centres_of(grid->transform());
  std::printf("origin %.17g %.17g %.17g, size %.17g\n", centres.origin.x, centres.origin.y,
              centres.origin.z, centres.axes[0].x);
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    const openvdb::CoordBBox box = value.getBoundingBox();
    std::printf("%d %d %d %d %d\n", box.min().x(), box.min().y(), box.min().z(), box.dim().x(),
                *value);
  }
}
