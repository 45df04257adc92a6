#include "io/dag/compact/plain_form.h"

#include <algorithm>
#include <utility>

#include "io/dag/dag_writer.h"
#include "streaming/sort/external_sort.h"

namespace svdag {
namespace {

// A node or brick with the number that the compact layout gives it.
struct NumberedNode {
  NodeKey children;
  uint32_t number;
  uint32_t unused[7];  // the sort takes records of 2^k bytes
};
struct NumberedBrick {
  Brick brick;
  uint32_t number, unused;
};

struct NodeWord {
  uint32_t operator()(const NumberedNode& node, size_t i) const { return node.children[i]; }
};
struct BrickWord {
  uint32_t operator()(const NumberedBrick& b, size_t i) const {
    return uint32_t(b.brick >> (i == 0 ? 32 : 0));
  }
};

class PlainLevels {
 public:
  PlainLevels(const DagFile& compact, const WorkRoom& room, DagWriter* writer)
      : file_(compact), dag_(compact.view()), room_(room), writer_(writer) {}

  void run() {
    write_bricks();
    for (uint32_t level = dag_.brick_level(); level-- > 0;) write_level(level);
  }

 private:
  // Passes the sorted records to add(record), which returns an index, and fills index_of_.
  template <class Record, class Word, class Fill, class Add>
  void sort(uint64_t count, size_t words, Word word, const Fill& fill, const Add& add) {
    WorkArray<uint32_t> index_of(count, room_);
    const uint64_t wanted = 2 * count * sizeof(Record) + kMinSort;
    ExternalSort<Record, Word> sort(
        {room_.budget, std::max(kMinSort, std::min(wanted, room_.budget->limit() / 2)), &executor_,
         [this] { return File::create_anonymous(room_.folder); }},
        words, word);
    for (uint32_t number = 0; number < count; ++number) sort.push(fill(number));
    Record last{};  // no key is zero
    sort.finish([&](const auto& records) {
      for (const Record& record : records) {
        bool equal = true;
        for (size_t i = 0; i < words; ++i) equal = equal && word(record, i) == word(last, i);
        if (equal) fail_input(file_.path(), "damaged file: two nodes of a level are equal");
        index_of[record.number] = add(record);
        last = record;
      }
    });
    index_of_ = std::move(index_of);
  }

  void write_bricks() {
    writer_->begin_level(int(dag_.brick_level()));
    sort<NumberedBrick>(
        dag_.brick_count, 2, BrickWord(),
        [&](uint32_t number) {
          return NumberedBrick{dag_.bricks[number], number, 0};
        },
        [&](const NumberedBrick& b) { return writer_->add_brick(b.brick); });
  }

  void write_level(uint32_t level) {
    writer_->begin_level(int(level));
    if (level == 0) return write_roots();
    const auto fill = [&](uint32_t number) {
      NumberedNode node{{}, number, {}};
      dag_for_children(dag_, level, number, [&](unsigned c, uint32_t child) {
        node.children[c] = 1 + index_of_[child];
      });
      return node;
    };
    sort<NumberedNode>(dag_.index_end[level], 8, NodeWord(), fill,
                       [&](const NumberedNode& n) { return writer_->add_node(n.children); });
  }

  // In the order of the file, as the table numbers them.
  void write_roots() {
    for (uint32_t number = 0; number < dag_.index_end[0]; ++number) {
      NodeKey root{};
      dag_for_children(dag_, 0, number,
                       [&](unsigned c, uint32_t child) { root[c] = 1 + index_of_[child]; });
      writer_->add_node(root);
    }
  }

  static constexpr uint64_t kMinSort = 4 * ExternalSortConfig::kMinBytesPerWorker;

  const DagFile& file_;
  const DagView& dag_;
  const WorkRoom& room_;
  DagWriter* writer_;
  SequentialExecutor executor_;
  WorkArray<uint32_t> index_of_;  // [number]: in the plain layout, of the level below
};

}  // namespace

std::optional<DagFile> plain_form(const DagFile& file, const WorkRoom& room) {
  if (file.layout() == Layout::kPlain) return std::nullopt;
  DagWriter writer(room.folder + "/plain.svdag", file.grid(), file.rule());
  PlainLevels(file, room, &writer).run();
  const Header& h = file.header();
  DagFile plain = writer.finish_unnamed(h.voxels, h.largest_snap, file.layers(), file.path());
  if (!std::equal(h.content_hash, h.content_hash + 2, plain.header().content_hash))
    fail_input(file.path(), "damaged file: its nodes do not match its content hash",
               offsetof(Header, content_hash));
  return plain;
}

}  // namespace svdag
