#include "builder/run/bake_output.h"

#include "builder/run/run_writer.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {

std::vector<uint64_t> DagOutput::key_counts() const {
  const Header& header = writer_.header();
  std::vector<uint64_t> keys;
  for (uint32_t k = 0; k < header.section_count; ++k) keys.push_back(header.sections[k].nodes);
  return keys;
}

std::string DagOutput::content_hash() const {
  const Header& header = writer_.header();
  return to_hex(header.content_hash);
}

void reject_foreign_format(const std::string& path) {
  for (const char* ending : {".vdb", ".nvdb", ".npz", ".npy", ".vox", ".binvox", ".svo", ".octree",
                             ".ply", ".stl", ".obj", ".off", ".gltf", ".glb"}) {
    if (path.ends_with(ending))
      fail_usage(path +
                 ": the output must be a .svdag or a .run: use svdag export for other formats");
  }
}

bool names_run(const std::string& path) {
  return path.ends_with(".run");
}

std::unique_ptr<BakeOutput> open_output(const std::string& path, const Grid& grid, Rule rule,
                                        const GridPart& part) {
  if (names_run(path)) return std::make_unique<RunWriter>(path, grid, rule, part);
  return std::make_unique<DagOutput>(path, grid, rule);
}

}  // namespace svdag
