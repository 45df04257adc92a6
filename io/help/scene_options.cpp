#include "io/help/scene_options.h"

#include <CLI/CLI.hpp>

#include "streaming/error.h"

namespace svdag {

void add_frames(CLI::App* app, SceneConfig* scene, const std::function<void()>& then) {
  app->add_option_function<std::string>(
         "--frames",
         [=](const std::string& text) {
           scene->frames = parse_frames(text);
           then();
         },
         "Pose a glTF scene at each time from A to B in steps; each is a layer, without a union")
      ->type_name("A:B:STEP");
}

void add_scene_choice(CLI::App* app, SceneConfig* scene) {
  app->add_option("--include", scene->names.include,
                  "Only parts whose object, material or file name matches a pattern (*, ?, [..]; "
                  "material:PATTERN for one kind); may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  app->add_option("--exclude", scene->names.exclude,
                  "Skip parts whose name matches a pattern; may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  app->add_flag("--allow-empty", scene->allow_unmatched, "Accept a pattern that matches no name");
  app->add_option_function<std::string>(
         "--time",
         [scene](const std::string& text) {
           if (!scene->frames.empty()) fail_usage("--time: --frames has the times: give one");
           scene->time = parse_time(text);
         },
         "Pose a glTF scene as its animations do at this time; without it, the pose at rest")
      ->type_name("SECONDS");
  app->add_option_function<std::string>(
         "--animation",
         [scene](const std::string& name) {
           if (!scene->time && scene->frames.empty())
             fail_usage("--animation needs the time of a pose: give --time, too");
           scene->animation = name;
         },
         "The animation of these times: its name, #NUMBER from 0, or all")
      ->type_name("NAME");
  app->add_flag("--hidden", scene->hidden, "Include nodes that the file hides");
  app->add_flag("--no-cutouts{false}", scene->cut_outs,
                "Take triangles whole whose material has transparent points (alphaMode MASK, map_d)");
  app->add_option_function<std::vector<std::string>>(
         "--cutout",
         [scene](const std::vector<std::string>& patterns) {
           if (!scene->cut_outs)
             fail_usage("--cutout: --no-cutouts bakes all materials whole: give one");
           scene->names.cut_out = patterns;
         },
         "Also cut out materials whose name matches a pattern, where the alpha of their texture is "
         "below 0.5; may be repeated")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  app->add_flag("--skip-invalid", scene->skip_invalid,
                "Drop triangles with NaN or infinite coordinates");
  app->add_flag("--allow-outside", scene->allow_outside,
                "Read .mtl files and textures outside the folder of an .obj file, too");
}

}  // namespace svdag
