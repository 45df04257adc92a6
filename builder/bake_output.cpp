#include "builder/bake_output.h"

#include "builder/run_writer.h"
#include "streaming/checksum.h"

namespace svdag {

std::vector<uint64_t> DagOutput::keys() const {
  const Header& header = writer_.header();
  std::vector<uint64_t> keys;
  for (uint32_t k = 0; k < header.section_count; ++k) keys.push_back(header.sections[k].nodes);
  return keys;
}

std::string DagOutput::content_hash() const {
  const Header& header = writer_.header();
  return to_hex({header.content_hash[0], header.content_hash[1]});
}

bool names_run(const std::string& path) {
  return path.ends_with(".run");
}

std::unique_ptr<BakeOutput> open_output(const std::string& path, const Grid& grid, Rule rule,
                                        const Part& part) {
  if (names_run(path)) return std::make_unique<RunWriter>(path, grid, rule, part);
  return std::make_unique<DagOutput>(path, grid, rule);
}

}  // namespace svdag
