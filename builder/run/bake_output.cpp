#include "builder/run/bake_output.h"

#include "builder/run/run_writer.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {

void DagOutput::finish(std::span<const SubDagRoot> roots, uint64_t voxels, double largest_snap,
                       LayerTable layers) {
  for (const SubDagRoot& root : roots) {
    const Subject subject = root.sets.subject;
    (is_layer(subject) ? layers.layers[layer_of(subject)].root : layers.union_root) = root.rank;
  }
  writer_.finish(voxels, largest_snap, std::move(layers));
}

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

void require_dag_name(const std::string& path, bool may_be_run) {
  if (path.ends_with(".svdag") || (may_be_run && names_run(path))) return;
  fail_usage(path + ": the output must end in .svdag" + (may_be_run ? " or .run" : "") +
             ": use svdag export for other formats");
}

bool names_run(const std::string& path) {
  return path.ends_with(".run");
}

std::unique_ptr<BakeOutput> open_output(const std::string& path, const Grid& grid, Rule rule,
                                        const GridPart& part, Layout layout, const WorkRoom& room) {
  if (!names_run(path)) return std::make_unique<DagOutput>(path, grid, rule, layout, room);
  if (layout != Layout::kPlain)
    fail_usage("--layout: a .run has no layout: choose it when merging");
  return std::make_unique<RunWriter>(path, grid, rule, part);
}

}  // namespace svdag
