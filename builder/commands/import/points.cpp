#include "builder/commands/import/points.h"

#include "io/formats/points/las_classes.h"
#include "streaming/error.h"
#include "streaming/file/input_watch.h"

namespace svdag {

PointVoxels::PointVoxels(std::unique_ptr<PointCloud> cloud, const std::string& path,
                         const PointChoice& choice)
    : cloud_(std::move(cloud)), path_(path) {
  if (choice.voxel_size.has_value() == (choice.levels != 0))
    fail_usage("points need a voxel size or a resolution: give -s or -r, not both");
  cloud_->has_colours = cloud_->has_colours && choice.with_colours;
  summary_ = summarize(*cloud_, path);
  grid_ = grid_of_points(*cloud_, summary_, choice.voxel_size, choice.levels, path);
  if (!choice.with_classes) return;
  layers_.kind = LayerKind::kMaterial;
  for (size_t number = 0; number < summary_.classes.size(); ++number) {
    if (!summary_.classes.test(number)) continue;
    labels_[number] = uint16_t(layers_.layers.size());
    const std::string name = las_class_name(uint8_t(number));
    layers_.layers.push_back({name, palette_colour(name)});
  }
}

GridPlacement PointVoxels::read(const VoxelSink& sink) const {
  const PointCells cells(*cloud_, summary_, grid_);
  std::vector<Voxel> voxels;
  std::vector<uint16_t> labels;
  std::vector<Colour> colours;
  cloud_->read([&](const PointBatch& batch) {
    voxels.clear();
    labels.clear();
    colours.clear();
    for (const Point& point : batch.points) {
      // A file that is written while it is read may hold other points than in the first pass.
      if (glm::min(point, summary_.min) != summary_.min ||
          glm::max(point, summary_.max) != summary_.max)
        fail_input(path_, kChangedInput);
      voxels.push_back(cells.of(point));
    }
    if (!layers_.empty())
      for (const uint8_t number : batch.classes) labels.push_back(labels_[number]);
    for (const PointColour& colour : batch.colours)
      colours.push_back(colour_of_point(colour, summary_));
    sink(voxels, labels, colours);
  });
  GridPlacement place;
  place.grid = grid_;
  return place;
}

}  // namespace svdag
