// The module svdag._svdag: files and their queries, and making a file of voxels. svdag/__init__.py
// checks the arguments and is the interface.
//
// Arrays come contiguous and of the right type. Long work runs on a thread of its own, without the
// GIL, while this one waits for signals: Ctrl-C ends it within 100 ms.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <optional>
#include <thread>

#include "builder/import/import.h"
#include "io/dag/layers/layer_index.h"
#include "io/dag/open_dag.h"
#include "io/dag/walk/occupied_bounds.h"
#include "python/queries.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace nb = nanobind;

namespace svdag {
namespace {

using Bools = nb::ndarray<nb::numpy, bool>;
using Bytes = nb::ndarray<nb::numpy, uint8_t>;
using Ints = nb::ndarray<nb::numpy, int32_t>;
using Doubles = nb::ndarray<nb::numpy, double>;
template <class T>
using Rows = nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Corner = std::array<int64_t, 3>;

// The thread that imports the module: Python handles signals only in its main thread.
const std::thread::id kMainThread = std::this_thread::get_id();

// Runs work() and returns when it is done. A signal that Python handles with an exception, such as
// KeyboardInterrupt, ends it.
template <class Work>
void interruptible(const Work& work) {
  std::exception_ptr failure;
  bool is_done = false;
  std::mutex mutex;
  std::condition_variable done;
  std::thread worker([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    is_done = true;
    done.notify_one();
  });
  bool signalled = false;
  {
    const nb::gil_scoped_release no_gil;
    std::unique_lock lock(mutex);
    while (!done.wait_for(lock, std::chrono::milliseconds(20), [&] { return is_done; })) {
      lock.unlock();
      if (!signalled && std::this_thread::get_id() == kMainThread) {
        const nb::gil_scoped_acquire gil;
        signalled = PyErr_CheckSignals() != 0;
      }
      if (signalled) pretend_interrupt(SIGINT);
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (signalled) {
    pretend_interrupt(0);
    throw nb::python_error();
  }
  if (failure) std::rethrow_exception(failure);
}

// An array that owns `values`.
template <class Array, class T>
Array owned(std::vector<T>&& values, std::initializer_list<size_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Array(kept->data(), shape, owner);
}

// The same for values that are written in parallel, so that no thread fills their memory first.
template <class Array, class T>
Array owned(std::unique_ptr<T[]>&& values, std::initializer_list<size_t> shape) {
  T* const kept = values.release();
  const nb::capsule owner(kept, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  return Array(kept, shape, owner);
}

// Zeros for an array: the system clears them when they are first used.
struct Zeros {
  explicit Zeros(size_t size)
      : bytes(static_cast<uint8_t*>(std::calloc(std::max<size_t>(1, size), 1))) {
    if (bytes == nullptr) throw std::bad_alloc();
    owner = nb::capsule(bytes, [](void* p) noexcept { std::free(p); });
  }
  uint8_t* bytes;
  nb::capsule owner;
};

// A path, whose bytes need not be UTF-8.
std::string string_of(const nb::bytes& bytes) {
  return {bytes.c_str(), bytes.size()};
}

VoxelBox box_of(const Corner& low, const Corner& high) {
  return {LatticePoint(low[0], low[1], low[2]), LatticePoint(high[0], high[1], high[2])};
}

class PyFile {
 public:
  // `level`, `bounds`: None, or what --level and --bounds take.
  PyFile(const nb::bytes& path, const std::vector<nb::bytes>& layers, std::optional<int> level,
         const std::optional<std::array<double, 6>>& bounds) {
    const std::string name = string_of(path);
    Selection selection;
    for (const nb::bytes& layer : layers) selection.layers.push_back(string_of(layer));
    selection.level = level;
    if (const auto& b = bounds)
      selection.bounds = Box{{(*b)[0], (*b)[1], (*b)[2]}, {(*b)[3], (*b)[4], (*b)[5]}};
    interruptible([&] { file_.emplace(open_dag(name, selection)); });
  }

  nb::dict info() const {
    const Header& h = file_->header();
    nb::dict info;
    info["levels"] = h.levels;
    info["voxel_size"] = h.voxel_size;
    info["corner"] = std::array{h.corner[0], h.corner[1], h.corner[2]};
    info["rule"] = rule_name(file_->rule());
    info["layout"] = layout_name(file_->layout());
    info["voxels"] = h.voxels;
    info["content_hash"] = to_hex(h.content_hash);
    info["metadata"] = nb::bytes(file_->metadata().data(), file_->metadata().size());
    nb::list layers;
    for (const Layer& layer : file_->layers().layers)
      layers.append(nb::make_tuple(nb::bytes(layer.name.data(), layer.name.size()),
                                   nb::make_tuple(layer.colour.r, layer.colour.g, layer.colour.b),
                                   layer.voxels));
    info["layers"] = layers;
    return info;
  }

  Bools window(const Corner& low, const Corner& high, uint32_t level, int layer,
               size_t threads) const {
    ParallelExecutor executor(threads_or_all(threads));
    const std::array<size_t, 3> n = size_of(low, high);
    const Zeros zeros(n[0] * n[1] * n[2]);
    const DagView dag = view(layer);
    interruptible([&] { fill_window(dag, level, box_of(low, high), zeros.bytes, &executor); });
    return Bools(zeros.bytes, {n[0], n[1], n[2]}, zeros.owner);
  }

  Bytes window_colours(const Corner& low, const Corner& high, uint32_t level, const Rgb& fill,
                       size_t threads) {
    ParallelExecutor executor(threads_or_all(threads));
    const std::array<size_t, 3> n = size_of(low, high);
    const Zeros zeros(n[0] * n[1] * n[2] * sizeof(Rgb));
    auto* const out = reinterpret_cast<Rgb*>(zeros.bytes);
    interruptible([&] {
      if (fill != Rgb{}) std::fill_n(out, n[0] * n[1] * n[2], fill);
      fill_window_colours(colours(), level, box_of(low, high), out, &executor);
    });
    return Bytes(zeros.bytes, {n[0], n[1], n[2], 3}, zeros.owner);
  }

  template <class T>
  Bytes colours_of(const Rows<T>& points, uint32_t level, const Rgb& fill, size_t threads) {
    ParallelExecutor executor(threads_or_all(threads));
    const size_t n = points.shape(0);
    std::vector<Rgb> found(n, fill);
    const std::span rows(reinterpret_cast<const std::array<T, 3>*>(points.data()), n);
    interruptible([&] { look_up_colours(colours().view(), level, rows, found.data(), &executor); });
    return owned<Bytes>(std::move(found), {n, 3});
  }

  Ints coords(const Corner& low, const Corner& high, uint32_t level, int layer) const {
    return list([&] { return list_voxels(view(layer), level, box_of(low, high)); });
  }

  Ints ball(const std::array<double, 3>& center, double radius, int layer) const {
    return list([&] {
      return list_ball(view(layer), {{center[0], center[1], center[2]}}, radius);
    });
  }

  std::tuple<Ints, nb::ndarray<nb::numpy, uint64_t>> bricks(const Corner& low, const Corner& high,
                                                            uint64_t first, size_t count,
                                                            int layer) const {
    std::vector<std::array<int32_t, 3>> corners;
    std::vector<uint64_t> words;
    interruptible([&] {
      for (const PlacedBrick& brick : next_bricks(view(layer), box_of(low, high), first, count)) {
        corners.push_back(brick.corner);
        words.push_back(brick.brick);
      }
    });
    const size_t n = words.size();
    return {owned<Ints>(std::move(corners), {n, 3}),
            owned<nb::ndarray<nb::numpy, uint64_t>>(std::move(words), {n})};
  }

  template <class T>
  Bools occupied(const Rows<T>& points, int layer, size_t threads) const {
    ParallelExecutor executor(threads_or_all(threads));
    std::vector<uint8_t> set(points.shape(0));
    const std::span rows(reinterpret_cast<const std::array<T, 3>*>(points.data()), set.size());
    interruptible([&] { look_up(view(layer), rows, set.data(), &executor); });
    const size_t n = set.size();
    return owned<Bools>(std::move(set), {n});
  }

  template <class T>
  std::tuple<Ints, Doubles> nearest(const Rows<T>& points, double max_distance, int layer,
                                    size_t threads) const {
    ParallelExecutor executor(threads_or_all(threads));
    const size_t n = points.shape(0);
    std::vector<std::array<int32_t, 3>> voxels(n);
    std::vector<double> distances(n);
    const std::span rows(reinterpret_cast<const std::array<T, 3>*>(points.data()), n);
    interruptible([&] {
      find_nearest(view(layer), rows, max_distance, voxels.data(), distances.data(), &executor);
    });
    return {owned<Ints>(std::move(voxels), {n, 3}), owned<Doubles>(std::move(distances), {n})};
  }

  bool box_occupied(const Corner& low, const Corner& high, int layer) const {
    bool found = false;
    interruptible([&] { found = any_in_box(view(layer), box_of(low, high)); });
    return found;
  }

  uint64_t count(const Corner& low, const Corner& high, uint32_t level, int layer) const {
    uint64_t voxels = 0;
    interruptible([&] {
      const VoxelBox grid{LatticePoint(0), LatticePoint(int64_t(1) << level)};
      VoxelBox box = box_of(low, high);
      box = {glm::max(box.min, grid.min), glm::min(box.max, grid.max)};
      if (!box.empty()) voxels = CubeWalk(view(layer), level).count_voxels(box);
    });
    return voxels;
  }

  // t is infinite, voxel and layer are -1, and the normal is 0 where nothing is hit. An array of
  // one row is that row n times.
  std::tuple<Doubles, Ints, nb::ndarray<nb::numpy, int8_t>, Ints> trace(
      const Rows<double>& origins, const Rows<double>& directions, double t_max, int layer,
      size_t threads) {
    ParallelExecutor executor(threads_or_all(threads));
    using Vector = std::array<int8_t, 3>;
    const size_t n = origins.shape(0) == 1 ? directions.shape(0) : origins.shape(0);
    if (directions.shape(0) != n && directions.shape(0) != 1)
      throw nb::value_error("trace: origins and directions have different lengths");
    const size_t origin_step = origins.shape(0) == 1 ? 0 : 3;
    const size_t direction_step = directions.shape(0) == 1 ? 0 : 3;
    const DagView dag = view(layer);
    const bool find_layers = layer < 0 && !file_->layers().empty();
    auto t = std::make_unique_for_overwrite<double[]>(n);
    auto voxels = std::make_unique_for_overwrite<std::array<int32_t, 3>[]>(n);
    auto normals = std::make_unique_for_overwrite<Vector[]>(n);
    auto layers = std::make_unique_for_overwrite<int32_t[]>(n);
    std::atomic<bool> is_valid = true;
    const auto make = [&](size_t first, std::span<Ray> rays) {
      for (size_t i = first; Ray & ray : rays) {
        const double* const o = origins.data() + i * origin_step;
        const double* const d = directions.data() + i * direction_step;
        const double far = std::max({std::abs(o[0]), std::abs(o[1]), std::abs(o[2])});
        const double length = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
        const double sum = o[0] + o[1] + o[2] + d[0] + d[1] + d[2];  // NaN if any is
        const bool valid = std::isfinite(sum) && far < 1e100 && length > 1e-90 && length < 1e90;
        if (!valid) is_valid = false;
        ray = valid ? ray_from_world(dag, {{o[0], o[1], o[2]}}, {{d[0], d[1], d[2]}})
                    : Ray{{{-1, -1, -1}}, {{-1, -1, -1}}};
        ++i;
      }
    };
    const auto take = [&](size_t first, std::span<const Hit> hits) {
      for (size_t i = first; const Hit& hit : hits) {
        t[i] = std::numeric_limits<double>::infinity();
        voxels[i] = {-1, -1, -1};
        normals[i] = {};
        layers[i] = -1;
        if (hit.found) {
          const size_t axis = size_t(hit.axis);
          t[i] = hit.t;
          voxels[i] = {int32_t(hit.voxel[0]), int32_t(hit.voxel[1]), int32_t(hit.voxel[2])};
          normals[i][axis] = directions.data()[i * direction_step + axis] < 0 ? 1 : -1;
          layers[i] = layer;
          if (find_layers)  // kNoLayer is -1
            layers[i] = int32_t(layer_of_cube(dag, index_->view(), hit.level, hit.voxel[0],
                                              hit.voxel[1], hit.voxel[2]));
        }
        ++i;
      }
    };
    interruptible([&] {
      if (find_layers) {
        const std::lock_guard lock(mutex_);
        if (!index_) index_.emplace(file_->layer_index());
      }
      trace_rays(dag, n, t_max, make, take, &executor);
    });
    if (!is_valid) throw nb::value_error("trace: a ray is not finite, or has no direction");
    return {owned<Doubles>(std::move(t), {n}), owned<Ints>(std::move(voxels), {n, 3}),
            owned<nb::ndarray<nb::numpy, int8_t>>(std::move(normals), {n, 3}),
            owned<Ints>(std::move(layers), {n})};
  }

  std::array<Corner, 2> occupied_box() const {
    const VoxelBox box = occupied_bounds(file_->view());
    return {Corner{box.min.x, box.min.y, box.min.z}, Corner{box.max.x, box.max.y, box.max.z}};
  }

 private:
  static std::array<size_t, 3> size_of(const Corner& low, const Corner& high) {
    return {size_t(high[0] - low[0]), size_t(high[1] - low[1]), size_t(high[2] - low[2])};
  }

  const DagColours& colours() {
    const std::lock_guard lock(mutex_);
    if (!colours_) colours_.emplace(*file_, &budget_);
    return *colours_;
  }

  // `layer`: its number; -1: the file's default.
  DagView view(int layer) const {
    return layer < 0 ? file_->view() : file_->view_of(size_t(layer));
  }

  template <class Find>
  static Ints list(const Find& find) {
    std::vector<std::array<int32_t, 3>> voxels;
    interruptible([&] { voxels = find(); });
    const size_t n = voxels.size();
    return owned<Ints>(std::move(voxels), {n, 3});
  }

  std::optional<DagFile> file_;
  MemoryBudget budget_{default_memory_limit()};
  std::optional<LayerIndex> index_;    // made by the first call that needs it, under mutex_
  std::optional<DagColours> colours_;  // the same
  std::mutex mutex_;
};

// Writes the file of voxels `coords`, in any order, with repetitions.
nb::dict from_coords(const Rows<uint32_t>& coords, const nb::bytes& path, int levels,
                     const std::array<double, 3>& corner, double voxel_size, uint64_t memory,
                     int rule, int layout, const nb::bytes& scratch) {
  ImportConfig config;
  config.source = config.output = string_of(path);
  config.scratch = string_of(scratch);
  config.levels = levels;
  config.memory = memory;
  config.rule = Rule(rule);
  config.layout = Layout(layout);
  ImportReport report;
  interruptible([&] {
    ParallelExecutor executor(available_processors());
    constexpr size_t kBatch = size_t(1) << 16;
    const auto* const voxels = reinterpret_cast<const Voxel*>(coords.data());
    const auto read = [&](const VoxelSink& sink, const FullCubeSink&) {
      for (size_t at = 0; at < coords.shape(0); at += kBatch) {
        check_interrupt();
        sink({voxels + at, std::min(kBatch, coords.shape(0) - at)}, {}, {});
      }
      return GridPlacement{Point(corner[0], corner[1], corner[2]), voxel_size,
                           uint64_t(1) << levels};
    };
    report = import_voxels(read, config, &executor, coords.shape(0));
  });
  nb::dict result;
  result["voxels"] = report.voxels;
  result["nodes"] = report.nodes;
  result["file_bytes"] = report.file_bytes;
  result["content_hash"] = report.content_hash;
  return result;
}

// Raises an Error as svdag.Error, and KeyboardInterrupt where another thread's Ctrl-C ended work.
void translate(const std::exception_ptr& exception, void* error_of) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    const nb::object path = nb::steal(
        PyUnicode_DecodeFSDefaultAndSize(error.path().data(), Py_ssize_t(error.path().size())));
    const nb::object sentence = nb::steal(
        PyUnicode_DecodeUTF8(error.what(), Py_ssize_t(std::strlen(error.what())), "replace"));
    const nb::object made =
        nb::handle(static_cast<PyObject*>(error_of))(sentence, int(error.code()), path);
    PyErr_SetObject(made.type().ptr(), made.ptr());
  } catch (const Interrupted&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  }
}

}  // namespace
}  // namespace svdag

NB_MODULE(_svdag, m) {
  using namespace svdag;
  m.attr("__version__") = SVDAG_VERSION;
  nb::object error_of = nb::module_::import_("svdag._error").attr("error_of");
  nb::register_exception_translator(translate, error_of.release().ptr());  // kept for good
  nb::class_<PyFile>(m, "File")
      .def(nb::init<const nb::bytes&, const std::vector<nb::bytes>&, std::optional<int>,
                    const std::optional<std::array<double, 6>>&>(),
           nb::arg("path"), nb::arg("layers"), nb::arg("level").none(), nb::arg("bounds").none())
      .def("info", &PyFile::info)
      .def("window", &PyFile::window)
      .def("window_colours", &PyFile::window_colours)
      .def("colours_voxels", &PyFile::colours_of<int64_t>)
      .def("colours_points", &PyFile::colours_of<double>)
      .def("coords", &PyFile::coords)
      .def("ball", &PyFile::ball)
      .def("bricks", &PyFile::bricks)
      .def("occupied_voxels", &PyFile::occupied<int64_t>)
      .def("occupied_points", &PyFile::occupied<double>)
      .def("nearest_voxels", &PyFile::nearest<int64_t>)
      .def("nearest_points", &PyFile::nearest<double>)
      .def("box_occupied", &PyFile::box_occupied)
      .def("count", &PyFile::count)
      .def("occupied_box", &PyFile::occupied_box)
      .def("trace", &PyFile::trace);
  m.def("from_coords", &from_coords);
}
