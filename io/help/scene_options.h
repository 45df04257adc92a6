// The options that choose what of a scene is baked, and in which pose: of a bake, and the same of
// the commands that judge it.
#pragma once

#include <functional>

#include "io/scene/scene.h"

namespace CLI {
class App;
}  // namespace CLI

namespace svdag {

// Adds --include, --exclude, --allow-empty, --time, --animation, --hidden,
// --no-cutouts, --cutout, --skip-invalid and --allow-outside.
void add_scene_choice(CLI::App* app, SceneConfig* scene);
// Adds --frames; before add_scene_choice(), since options are applied in the order of their
// definition. `then` is called after it is applied.
void add_frames(CLI::App* app, SceneConfig* scene, const std::function<void()>& then);

}  // namespace svdag
