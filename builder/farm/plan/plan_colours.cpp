#include "builder/farm/plan/plan_colours.h"

#include <nlohmann/json.hpp>

#include "io/json.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

// Every member is bound, so a new one that the pass needs must be stored. The pass has no frames,
// and sets colours and paint itself.
Json scene_json(const SceneConfig& scene) {
  [[maybe_unused]] const auto& [paths, names, skip_invalid, sandbox, allow_unmatched, allow_outside,
                                transform, up, scale, hidden, time, frames, animation, cut_outs,
                                colours, paint, keep_images, only] = scene;
  Json json = {{"include", names.include},
               {"exclude", names.exclude},
               {"cut_out", names.cut_out},
               {"skip_invalid", skip_invalid},
               {"sandbox", sandbox},
               {"allow_empty", allow_unmatched},
               {"allow_outside", allow_outside},
               {"hidden", hidden},
               {"animation", animation},
               {"cut_outs", cut_outs}};
  for (const std::string& path : paths) json["paths"].push_back(absolute_path(path));
  if (time) json["time"] = *time;
  return json;
}

SceneConfig get_scene(const Json& json) {
  SceneConfig scene;
  json.at("paths").get_to(scene.paths);
  json.at("include").get_to(scene.names.include);
  json.at("exclude").get_to(scene.names.exclude);
  json.at("cut_out").get_to(scene.names.cut_out);
  scene.skip_invalid = json.at("skip_invalid");
  scene.sandbox = json.at("sandbox");
  scene.allow_unmatched = json.at("allow_empty");
  scene.allow_outside = json.at("allow_outside");
  scene.hidden = json.at("hidden");
  scene.animation = json.at("animation");
  scene.cut_outs = json.at("cut_outs");
  if (json.contains("time")) scene.time = json.at("time").get<double>();
  scene.colours = scene.paint = true;
  return scene;
}

}  // namespace

Json colours_json(const PlanColours& colours) {
  Json json = {{"error", colours.pass.error}};
  if (colours.pass.level) json["level"] = *colours.pass.level;
  json["scene"] = scene_json(colours.scene);
  return json;
}

PlanColours get_colours(const Json& json) {
  PlanColours colours;
  colours.pass.error = whole_number<uint32_t>(json.at("error"));
  if (json.contains("level")) colours.pass.level = whole_number<int>(json.at("level"));
  colours.scene = get_scene(json.at("scene"));
  return colours;
}

}  // namespace svdag
