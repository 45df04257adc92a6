// Prints the grid `layer` of a .vdb, or the one with the given name, read by OpenVDB itself: its
// metadata, then the boxes of its active values, as x0 y0 z0 side label, or side r g b.
#include <cstdio>
#include <string>

#include "io/formats/vdb/vdb_trees.h"

namespace {

void print_value(openvdb::Int32 label) {
  std::printf("%d\n", label);
}
void print_value(const openvdb::Vec3s& light) {
  std::printf("%.9g %.9g %.9g\n", double(light.x()), double(light.y()), double(light.z()));
}

template <class GridType>
int dump(const openvdb::GridBase::Ptr& base) {
  const auto grid = openvdb::gridPtrCast<GridType>(base);
  if (!grid) return 1;
  for (auto entry = grid->beginMeta(); entry != grid->endMeta(); ++entry)
    std::printf("%s=%s\n", entry->first.c_str(), entry->second->str().c_str());
  std::printf("background ");
  print_value(grid->background());
  std::printf("leaves %zu\n", size_t(grid->tree().leafCount()));
  const svdag::IndexToWorld centres = svdag::centres_of(grid->transform());
  std::printf("origin %.17g %.17g %.17g, size %.17g\n", centres.origin.x, centres.origin.y,
              centres.origin.z, centres.axes[0].x);
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    const openvdb::CoordBBox box = value.getBoundingBox();
    std::printf("%d %d %d %d ", box.min().x(), box.min().y(), box.min().z(), box.dim().x());
    print_value(*value);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  openvdb::initialize();
  openvdb::io::File file(argv[1]);
  file.open(/*delayLoad=*/false);
  for (auto name = file.beginName(); name != file.endName(); ++name)
    std::printf("grid %s\n", name.gridName().c_str());
  if (argc == 3) return dump<openvdb::Vec3SGrid>(file.readGrid(argv[2]));
  return dump<openvdb::Int32Grid>(file.readGrid("layer"));
}
