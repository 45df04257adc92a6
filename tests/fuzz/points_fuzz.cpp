// Any bytes are points, or an Error (bad input), of every format: the first byte chooses it.
#include "io/formats/points/point_files.h"
#include "io/formats/points/point_grid.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  constexpr std::unique_ptr<PointCloud> (*kReaders[])(const File&) = {open_las, open_xyz, open_pcd,
                                                                      open_ply_points};
  if (size == 0) return 0;
  const MemoryFile memory(std::as_bytes(std::span(data + 1, size - 1)));
  try {
    std::array<PointInput, 1> inputs;
    auto& [path, cloud, summary] = inputs[0];
    cloud = kReaders[data[0] % std::size(kReaders)](memory.file());
    summary = summarize(*cloud, path);
    if (summary.empty()) return 0;
    const Grid grid = grid_of_points(inputs, 1.0, 0);
    const PointCells cells(inputs[0], grid);
    uint64_t count = 0;
    cloud->read([&](const PointBatch& batch) {
      count += batch.points.size();
      if (!batch.colours.empty() && batch.colours.size() != batch.points.size()) std::abort();
      if (!batch.classes.empty() && batch.classes.size() != batch.points.size()) std::abort();
      for (const Point& point : batch.points)
        for (const uint32_t k : cells.of(point))
          if (k >> grid.levels != 0) std::abort();
    });
    if (count != inputs[0].summary.count) std::abort();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kUsage) expect_bad_input(error);  // a grid that is too large
  }
  return 0;
}
