// The table of scene formats: a row per format. To add one, add a row and its reader
// (io/scene/readers/), and remove its row from the formats that svdag names but does not read.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/scene/polygons/mesh_writer.h"

namespace svdag {

// Files beside a scene file that determine its triangles; with `colours`, also their colours.
using VisitFile = std::function<void(const File&)>;
struct BesideOptions {
  MemoryBudget* budget = nullptr;
  bool colours = false;
  bool allow_outside = false;            // as in ReadOptions
  const NameFilter* cut_outs = nullptr;  // not null: the images of materials that it cuts out
};
using VisitBeside = void (*)(const File& content, const BesideOptions& options,
                             const VisitFile& visit);

struct SceneFormat {
  const char* name;
  std::string_view ending;  // without the dot, lower case
  bool usual_as_gz;         // completion of file names offers ".gz", too
  // Whether a file with these first bytes has this format whatever its name; null: no such bytes.
  // The free text at the head of an .stl file may begin with any word.
  bool (*begins)(std::string_view start, bool is_named_stl);
  std::string_view weak_start;  // decides for a file whose ending is unknown; empty: nothing does
  // Null: this build lacks the library.
  MeshReader read;
  const char* alternative = "";  // for builds that lack it: ": what to do"
  VisitBeside visit_beside = nullptr;
  bool (*holds_only_points)(const File&) = nullptr;
  std::vector<Animation> (*animations)(const File& content, const ReadOptions&) = nullptr;
};

// Detects the format by content, or by ending where content is ambiguous (.obj, .stl, .off). Of a
// gzip file, only the first bytes are unpacked, and its ".gz" is ignored.
// An unknown file is an Error (kBadInput) that lists what can be read.
const SceneFormat& detect_format(const File& file);

// Reads `file`, of this format. An Error (kBadInput) if this build cannot.
LeftOut read_scene_file(const SceneFormat& format, const File& file, const ReadOptions& options,
                        const TriangleSink& sink);

// ".ply" and so on, for the completion of file names.
std::vector<std::string> scene_endings();

// For formats that svdag does not read, recognised by a lower-case ending or the first bytes: the
// format's name and a way to convert it, as a sentence. Empty if the format is not known.
std::string foreign_format_message(std::string_view ending, std::string_view start);

}  // namespace svdag
