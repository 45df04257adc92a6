#include "builder/farm/plan/plan_index.h"

#include "builder/split/bin_record.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

constexpr const char* kIndex = "index";

std::string hash_of(std::span<const std::byte> bytes) {
  Hasher128 hasher;
  hasher.update(bytes);
  return to_hex(hasher.digest());
}

// Every member is bound, so a new one that the shards use must be stored. The split has used the
// others but for the rule (in plan.json), the kind of the layers (with their names) and the layout
// (of the merge).
void put_content(const ContentOptions& options, RecordWriter* record) {
  [[maybe_unused]] const auto& [layout, rule, levels, voxel_size, open_as_sheets, layers,
                                with_union, cube, origin, bounds] = options;
  record->put(uint32_t(with_union));
}

void get_content(RecordReader* in, ContentOptions* options) {
  uint32_t with_union = 0;
  in->get(&with_union);
  in->require(with_union <= 1, "impossible layers");
  options->with_union = with_union == 1;
}

}  // namespace

std::string save_index(const Plan& plan) {
  RecordWriter record;
  record.put(uint64_t(plan.block_bytes));
  put_bins(plan.bins, &record);
  put_layers(plan.layers, &record);
  put_windings(plan.windings.get(), &record);
  put_cut_outs(plan.cut_outs, &record);
  put_content(plan.content, &record);
  AtomicFile file(plan.path(kIndex));
  file.append(record.bytes());
  file.commit();
  return hash_of(record.bytes());
}

void load_index(const std::string& hash, Plan* plan) {
  const File file = File::open_read(plan->path(kIndex));
  std::vector<std::byte> bytes(file.size());
  file.read_at(0, bytes);
  if (hash_of(bytes) != hash)
    fail_input(file.path(), "does not match plan.json: create the plan again with svdag plan");
  RecordReader in(bytes, file.path(), ExitCode::kBadInput);
  uint64_t block_bytes = 0;
  in.get(&block_bytes);
  in.require(Scratch::is_block_size(block_bytes), "invalid block size");
  plan->block_bytes = size_t(block_bytes);
  plan->bins = get_bins(&in, plan->grid.levels);
  plan->layers = get_layers(&in);
  plan->windings = get_windings(&in, plan->grid.levels);
  plan->cut_outs = get_cut_outs(&in);
  in.require((plan->windings != nullptr) == is_solid(plan->content.rule),
             "winding numbers do not fit the rule");
  plan->content.layers = plan->layers.kind();
  get_content(&in, &plan->content);
  in.finish();
}

}  // namespace svdag
