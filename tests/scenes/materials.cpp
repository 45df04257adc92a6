#include "tests/scenes/materials.h"

#include <algorithm>
#include <iterator>

namespace svdag::scenes {
namespace {

constexpr std::array<double, 3> kWhite{1, 1, 1};

// Every feature of base colours that readers tell apart is in one of them.
const Material kMaterials[] = {
    {"limestone", kWhite, &kLimestone, Chart::kAlong, 3},
    {"marble", kWhite, &kMarble, Chart::kAlong, 1},
    {"brick", kWhite, &kBricks, Chart::kAlong, 2, Wrapping::kMirror},
    {"mosaic", kWhite, &kMosaic, Chart::kAlong, 3},
    {"terracotta", kWhite, &kTerracotta, Chart::kAlong, 1.5},
    {"painted", kWhite, &kPainted, Chart::kWhole, 1, Wrapping::kClamp},
    {"red cloth", kWhite, &kRedBrocade, Chart::kAlong, 0.75, Wrapping::kRepeat, 1},
    {"blue cloth", kWhite, &kBlueBrocade, Chart::kAlong, 0.75, Wrapping::kRepeat, 1},
    {"leaves", kWhite, &kFern, Chart::kWhole, 1, Wrapping::kClamp, 0, true},
    {.name = "roof", .factor = {0.48, 0.09, 0.04}, .tinted = true},
    {"skin", {0.60, 0.33, 0.22}},
    {"hair", {0.06, 0.03, 0.02}},
    {"shirt", {0.62, 0.06, 0.05}},
    {"trousers", {0.05, 0.09, 0.22}},
    {"shoe", {0.05, 0.04, 0.03}},
};

}  // namespace

const Material* find_material(const std::string& name) {
  const auto found = std::ranges::find(kMaterials, name, &Material::name);
  return found == std::end(kMaterials) ? nullptr : found;
}

}  // namespace svdag::scenes
