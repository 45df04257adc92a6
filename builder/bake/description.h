// Everything that determines the bytes of a bake, as text: one "name: value" per line.
//
// A bake can be resumed if and only if its description is the same. Threads, memory and cells are
// not part of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/build.h"

namespace svdag {

// The files of a scene. Reads what is not hashed of them.
std::vector<SceneFile> scene_files(const Scene& scene, ContentHashes hashed = {});

// The scene as the description has it: with the images of colours.
SceneConfig described_scene(const BuildConfig& config);

// Of the colours that a pass over the file with this content hash adds. `files`: of the scene.
std::string describe_colours(const ColourPassConfig& pass, const SceneConfig& scene,
                             const std::string& content_hash, const std::vector<SceneFile>& files);

// `files`: of the scene; not needed if config.ready is set, since the plan describes them.
std::string describe(const BuildConfig& config, const std::vector<SceneFile>& files);

// 32 hex digits. Bakes whose descriptions have the same hash give the same bytes.
std::string hash_of_description(const std::string& description);

// Whether `description`, without a part, is of a bake with this rule and a grid of this size.
bool describes(const std::string& description, Rule rule, const Grid& grid);

// Whether `description`, with or without a part, is of the algorithm of this program, which then
// gives the same bytes.
bool is_of_this_algorithm(const std::string& description);

// The description and files of one bake. Hashes may require reading the whole scene, so they are
// computed on demand and once; Error if the scene has changed since the bake read it.
class Description {
 public:
  // `hashed`: what the bake read of the files, since watch_files().
  Description(const BuildConfig& config, const Scene& scene, ContentHashes* hashed)
      : config_(config), scene_(scene), hashed_(hashed) {}

  // Records the state of the scene's files; call before the scene is read.
  void watch_files() { watch_ = scene_.watch(); }
  const InputWatch& watch() const { return watch_; }
  // Error (kBadInput) if a file has changed since.
  void check_files() const { watch_.check(); }

  const std::vector<SceneFile>& files();
  std::string text();
  // The text; nothing once the scene has changed since the bake read it.
  std::optional<std::string> text_if_unchanged();

 private:
  const BuildConfig& config_;
  const Scene& scene_;
  ContentHashes* hashed_;
  InputWatch watch_;
  std::vector<SceneFile> files_;
  bool changed_ = false;
};

// The first difference between two descriptions, as text for users; empty if they are equal.
std::string difference(const std::string& saved, const std::string& now);

}  // namespace svdag
