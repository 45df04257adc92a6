// What decides the bytes of a bake, as text: one "name: value" per line.
//
// A bake may be resumed if and only if its description is the same. Threads, memory and cells are
// no part of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/bake/scene_watch.h"
#include "builder/build.h"

namespace svdag {

// The files that a scene is made of. Reads all of them once, for their hashes.
std::vector<SceneFile> scene_files(const Scene& scene);

// `files`: of the scene; a bake that is `ready` needs none, for its plan has described them.
std::string describe(const BuildConfig& config, const std::vector<SceneFile>& files);

// Whether this program would give the same bytes for `description`, which may be without a part.
bool is_of_this_algorithm(const std::string& description);

// Both, of one bake. Hashes cost a reading of the whole scene: they are made when needed, and once,
// and they are those of what the bake has read, or an Error.
class Description {
 public:
  Description(const BuildConfig& config, const Scene& scene)
      : config_(config), scene_(scene), watch_(scene) {}

  // Of the scene; begin it before the scene is read.
  SceneWatch* watch() { return &watch_; }

  const std::vector<SceneFile>& files();
  std::string text();
  // The text, or nothing from the moment on when the scene is no more what the bake has read.
  std::optional<std::string> text_if_unchanged();

 private:
  const BuildConfig& config_;
  const Scene& scene_;
  SceneWatch watch_;
  std::vector<SceneFile> files_;
  bool changed_ = false;
};

// What differs first between two descriptions, for people; empty if nothing does.
std::string difference(const std::string& saved, const std::string& now);

}  // namespace svdag
