#include "builder/commands/import/points.h"

#include <algorithm>
#include <filesystem>

#include "io/formats/points/las_classes.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/input_watch.h"

namespace svdag {

PointVoxels::PointVoxels(std::vector<PointInput> inputs, const PointChoice& choice)
    : inputs_(std::move(inputs)) {
  const bool has_size = choice.voxel_size.has_value(), has_levels = choice.levels != 0;
  const std::optional<Grid> own = inputs_.size() == 1 ? inputs_[0].cloud->grid : std::nullopt;
  const bool is_own = own && !has_size && !has_levels;
  if (has_size == has_levels && !is_own)
    fail_usage(std::string("points need a voxel size or a resolution: give -s or -r") +
               (has_size ? ", not both" : ""));
  const bool has_colours = choice.with_colours && std::ranges::all_of(inputs_, [](const auto& i) {
                             return i.cloud->has_colours;
                           });
  for (auto& [path, cloud, summary] : inputs_) {
    cloud->has_colours = has_colours;
    summary = summarize(*cloud, path);
    count_ += summary.count;
    left_out_ += summary.left_out;
    brightest_ = std::max(brightest_, summary.brightest);
  }
  if (count_ == 0 && !is_own)
    fail_input(inputs_.front().path,
               "has no points" + (left_out_ == 0 ? ""
                                                 : ", except " + format_count(left_out_) +
                                                       " without a position or withheld"));
  grid_ = is_own ? *own : grid_of_points(inputs_, choice.voxel_size, choice.levels);
  if (is_own) {
    rule_ = Rule::kConservative;  // the file does not record it
    if (!holds(grid_, inputs_))
      fail_input(inputs_[0].path, "has points outside of the grid of its header");
  }
  add_layers(choice.layers);
}

void PointVoxels::add_layers(LayerKind kind) {
  layers_.kind = kind;
  const auto number_of = [&](const std::string& name) {
    const auto found = std::ranges::find(layers_.layers, name, &Layer::name);
    const auto number = uint16_t(found - layers_.layers.begin());
    if (found == layers_.layers.end()) layers_.layers.push_back({name, palette_colour(name)});
    return number;
  };
  if (kind == LayerKind::kMaterial) {
    std::bitset<256> classes;
    for (const PointInput& input : inputs_) classes |= input.summary.classes;
    for (size_t number = 0; number < classes.size(); ++number)
      if (classes.test(number)) of_classes_[number] = number_of(las_class_name(uint8_t(number)));
  }
  for (const PointInput& input : inputs_)
    of_files_.push_back(kind == LayerKind::kFile
                            ? number_of(std::filesystem::path(input.path).filename().string())
                            : uint16_t(0));
}

GridPlacement PointVoxels::read(const VoxelSink& sink) const {
  for (size_t i = 0; i < inputs_.size(); ++i) read(inputs_[i], of_files_[i], sink);
  GridPlacement place;
  place.grid = grid_;
  return place;
}

void PointVoxels::read(const PointInput& input, uint16_t label, const VoxelSink& sink) const {
  const PointSummary& summary = input.summary;
  const PointCells cells(input, grid_);
  std::vector<Voxel> voxels;
  std::vector<uint16_t> labels;
  std::vector<Colour> colours;
  input.cloud->read([&](const PointBatch& batch) {
    voxels.clear();
    labels.clear();
    colours.clear();
    for (const Point& point : batch.points) {
      // A file that is written while it is read may hold other points than in the first pass.
      if (glm::min(point, summary.min) != summary.min ||
          glm::max(point, summary.max) != summary.max)
        fail_input(input.path, kChangedInput);
      voxels.push_back(cells.of(point));
    }
    if (layers_.kind == LayerKind::kFile) labels.assign(voxels.size(), label);
    if (layers_.kind == LayerKind::kMaterial)
      for (const uint8_t number : batch.classes) labels.push_back(of_classes_[number]);
    for (const PointColour& colour : batch.colours)
      colours.push_back(colour_of_point(colour, brightest_));
    sink(voxels, labels, colours);
  });
}

}  // namespace svdag
