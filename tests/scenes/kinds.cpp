#include "tests/scenes/kinds.h"

#include "streaming/error.h"

namespace svdag::scenes {

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"atrium", 260'000, make_atrium},   {"hairball", 2'880'000, make_hairball},
      {"scan", 1'000'000, make_scan},     {"city", 120'000, make_city},
      {"terrain", 500'000, make_terrain}, {"rectangle", 2, make_rectangle},
      {"sheet", 2, make_sheet},           {"speck", 1'000'000, make_speck},
      {"figure", 20'000, make_figure}};
  return all;
}

std::unique_ptr<Mesh> make_scene(const std::string& name, uint64_t triangles, uint64_t seed) {
  constexpr uint64_t kMaxTriangles = uint64_t(1) << 32;
  std::string names;
  for (const Kind& kind : kinds()) {
    if (triangles > kMaxTriangles)
      fail_usage("--triangles: at most " + std::to_string(kMaxTriangles) +
                 " triangles can be made");
    if (kind.name == name)
      return kind.make(triangles == 0 ? kind.default_triangles : triangles, seed);
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  }
  fail_usage("\"" + name + "\" is not a kind of scene: choose one of " + names);
}

}  // namespace svdag::scenes
