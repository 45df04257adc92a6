#include "verify/report/report_html.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "io/dag/walk/occupied_bounds.h"
#include "io/json.h"
#include "io/units.h"
#include "io/verdict.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/file/file.h"
#include "verify/report/report_plots.h"
#include "verify/report/report_style.h"
#include "verify/report/report_text.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

double share_of(uint64_t part, uint64_t whole) {
  return whole == 0 ? 0 : std::min(1.0, double(part) / double(whole));
}

std::string percent(double share) {
  return formatted("%.3g", 100 * share) + " %";
}

bool is_ok(const Json& verdict) {
  return verdict.at(verdict.contains("same") ? "same" : "ok").get<bool>();
}

std::string hash_of(const DagFile& file) {
  const Header& h = file.header();
  return to_hex(h.content_hash);
}

// Writes the page from top to bottom: one function per section, in the order of make().
class Page {
 public:
  // `bake`: the report of the bake, or null.
  Page(const Json& bake, const std::vector<Json>& verdicts, const DagFile& file,
       const DagStats& stats, const IntegrityReport& integrity)
      : bake_(bake), verdicts_(verdicts), file_(file), stats_(stats), integrity_(integrity) {}

  std::string make(const std::vector<ReportPicture>& pictures, const EmbeddedViewer& viewer = {}) {
    const std::string& output = file_.path();
    const std::string name = escaped(base_name(output));
    // The policy prevents the browser from loading anything from elsewhere.
    out_ =
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"><meta "
        "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src " +
        (viewer.level == 0 ? "'none'" : viewer.script_hash) + "\"><title>" + name +
        "</title><style>" + kReportStyle + viewer.style + "</style>\n<h1>" + name + "</h1>\n";
    tiles();
    soundness();
    for (const Json& verdict : verdicts_) show(verdict);
    if (baked()) warnings();
    if (stats_.voxels == 0) box("note", "No voxel is set.");
    if (viewer.level != 0) out_ += viewer.html;
    show(pictures);
    if (!file_.layers().empty()) legend();
    contents();
    if (baked()) accuracy();
    levels();
    if (baked()) work();
    if (baked()) skipped();
    out_ += "<footer>Made by svdag-verify report";
    if (baked())
      out_ += " of what svdag " + escaped(bake_.at("svdag").get<std::string>()) + " baked";
    out_ += ".</footer></html>\n";
    return std::move(out_);
  }

 private:
  bool baked() const { return !bake_.is_null(); }
  uint64_t count(const char* key) const { return whole_number<uint64_t>(bake_.at(key)); }
  double number(const char* key) const { return bake_.at(key).get<double>(); }
  // From the file, not from the bake's report, like all that the file contains.
  double bits_per_voxel() const {
    return stats_.voxels == 0 ? 0 : 8 * double(file_.header().file_bytes) / double(stats_.voxels);
  }
  std::vector<uint64_t> divided_per_level() const {
    std::vector<uint64_t> counts;
    if (!baked()) return counts;
    for (const Json& one : bake_.at("cubes_divided")) counts.push_back(whole_number<uint64_t>(one));
    return counts;
  }
  size_t cell_level() const {
    const uint64_t level = count("cell_level");
    if (level <= stats_.levels.size()) return level;
    throw Error(ExitCode::kBadInput, "has a \"cell_level\" below the finest level");
  }

  void box(const char* kind, const std::string& text) {
    out_ += std::string("<p class=\"verdict ") + kind + "\">" + text + "</p>\n";
  }
  void tile(const std::string& value, const std::string& what) {
    out_ += "<div><b>" + value + "</b><span>" + what + "</span></div>\n";
  }
  void begin_facts(const std::string& title) {
    out_ += "<h2>" + title + "</h2>\n<div class=\"card\"><table class=\"facts\">\n";
  }
  void row(const std::string& name, const std::string& value) {
    out_ += "<tr><th>" + name + "<td>" + value + "\n";
  }
  void end_table() { out_ += "</table></div>\n"; }

  void tiles() {
    out_ += "<div class=\"tiles\">\n";
    tile(format_resolution(file_.view().resolution()) + "<sup>3</sup>", "grid");
    if (baked()) tile(short_count(count("triangles")), "triangles");
    tile(short_count(stats_.voxels), "voxels");
    tile(short_count(stats_.dag_nodes()), "DAG nodes");
    tile(format_bytes(file_.header().file_bytes), "file");
    tile(formatted("%.3g", bits_per_voxel()), "bits per voxel");
    if (baked())
      tile(formatted("%.1f s", bake_.at("seconds").at("total").get<double>()), "to bake");
    out_ += "</div>\n";
  }

  // A verdict of svdag-verify: what was judged, and what was wrong.
  void show(const Json& verdict) {
    const auto command = verdict.at("command").get<std::string>();
    const auto counted = [&](const char* key) {
      return format_count(whole_number<uint64_t>(verdict.at(key)));
    };
    std::string text;
    if (command == "mesh" && verdict.at("judge") == "openvdb")
      text = "OpenVDB's distances at " + counted("tested") + " voxels";
    else if (command == "mesh")
      text = "the " + escaped(verdict.at("judge").get<std::string>()) + " judge, " +
             counted("bricks") + " bricks of 4<sup>3</sup> voxels" +
             (verdict.at("sampled").get<bool>() ? ", sampled" : ", all of them");
    else if (command == "trace")
      text = counted("rays") + " rays, " + counted("voxels") + " voxels and " + counted("points") +
             " points of the surface: " + counted("late") + " late, " + counted("far") + " far, " +
             counted("uncovered") + " uncovered";
    else if (command == "vdb")
      text = "OpenVDB grid " + escaped(verdict.at("vdb").get<std::string>()) + ", " +
             counted("both") + " voxels of both";
    else if (command != "check")
      throw Error(ExitCode::kBadInput, "is a verdict of an unknown command");
    if (command == "mesh" || command == "vdb")
      text += ": " + counted("missing") + " missing, " + counted("extra") + " extra";
    const bool good = is_ok(verdict);
    box(good ? "good" : "bad", "<b>svdag-verify " + escaped(command) +
                                   "</b>: " + (good ? "ok" : "not ok") +
                                   (text.empty() ? "" : "; " + text) + ".");
  }

  void soundness() {
    if (integrity_.sound()) {
      box("good", "Sound: every checksum is right; the DAG is in canonical order and minimal.");
    } else {
      std::string text = "This file is not sound:";
      for (const std::string& defect : integrity_.defects) text += "<br>" + escaped(defect);
      box("bad", text);
    }
  }

  void warnings() {
    if (count("triangles_invalid") > 0)
      box("note", format_count(count("triangles_invalid")) +
                      " triangles with NaN or infinite coordinates were dropped.");
    for (const Json& pattern : bake_.at("patterns_unmatched"))
      box("note",
          "No part of the scene matches <code>" + escaped(pattern.get<std::string>()) + "</code>.");
    if (count("triangles_undeformed") > 0)
      box("note", format_count(count("triangles_undeformed")) +
                      " triangles were baked as stored: skins and morph targets are not applied.");
    if (count("triangles_outside") + count("triangles_clipped") > 0)
      box("note", format_count(count("triangles_outside")) + " triangles are outside the grid, " +
                      format_count(count("triangles_clipped")) + " extend beyond it.");
    if (number("quantisation_voxels") > 0.5)
      box("note", "The scene's positions are quantised in steps of " +
                      formatted("%.3g", number("quantisation_voxels")) + " voxels.");
    if (bake_.at("resumed").get<bool>())
      box("note", "The bake was resumed: times, memory and skipped work are of its last process.");
  }

  void show(const std::vector<ReportPicture>& pictures) {
    if (pictures.empty()) return;
    out_ += "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : pictures)
      out_ += "<figure><img alt=\"" + escaped(picture.caption) + "\" src=\"data:image/png;base64," +
              base64(picture.png) + "\"><figcaption>" + escaped(picture.caption) +
              "</figcaption></figure>\n";
    out_ += "</div>\n";
  }

  void scene_files() {
    for (const Json& source : bake_.at("files"))
      row("scene file", escaped(source.at("name").get<std::string>()) + ", " +
                            format_bytes(whole_number<uint64_t>(source.at("bytes"))) +
                            "<br><code>" + escaped(source.at("hash").get<std::string>()) +
                            "</code>");
    row("triangles", format_count(count("triangles")));
    if (const Json& bounds = bake_.at("scene_bounds"); !bounds.is_null())
      row("bounds of the scene", box_text({point_of(bounds.at(0)), point_of(bounds.at(1))}));
  }

  static Point point_of(const Json& point) {
    return {point.at(0).get<double>(), point.at(1).get<double>(), point.at(2).get<double>()};
  }

  static std::string box_text(const Box& box) {
    const auto point = [](const Point& p) {
      return formatted("%.6g", p.x) + ", " + formatted("%.6g", p.y) + ", " + formatted("%.6g", p.z);
    };
    return point(box.min) + " to " + point(box.max);
  }

  void contents() {
    const Grid grid = file_.grid();
    const Point corner = grid.corner();
    begin_facts("What was baked");
    if (baked()) scene_files();
    row("grid", format_resolution(grid.resolution()) + "<sup>3</sup> voxels of " +
                    format_double(grid.voxel_size) +
                    (grid.kind == Grid::Kind::kBox       ? ", fitted to a box"
                     : grid.kind == Grid::Kind::kLattice ? ", on the world lattice"
                                                         : ", with a corner at the given origin"));
    row("corner of the grid",
        format_double(corner.x) + ", " + format_double(corner.y) + ", " + format_double(corner.z));
    row("rule", rule_name(file_.rule()));
    if (!file_.view().empty()) {
      row("bounds of the voxels", box_text(world_box(grid, occupied_bounds(file_.view()))));
    }
    row("voxels", format_count(stats_.voxels));
    row("content hash of the result", "<code>" + hash_of(file_) + "</code>");
    end_table();
  }

  void accuracy() {
    begin_facts("Accuracy");
    row("largest move of a coordinate by the snap",
        formatted("%.3g voxel", file_.header().largest_snap) + ", to a lattice of 2<sup>" +
            std::to_string(file_.header().fraction) + "</sup> steps per voxel");
    row("decisions at voxels", format_count(count("decisions")));
    row("decided in integers, because doubles could not", percent(number("decisions_exact_share")));
    row("triangles of zero area, baked as segments or points",
        format_count(count("triangles_degenerate")));
    if (number("quantisation_voxels") > 0)
      row("steps of the file's own quantisation",
          formatted("%.3g voxel", number("quantisation_voxels")));
    end_table();
  }

  void levels() {
    PlotLine svo{"octree nodes", "one", {}}, dag{"DAG nodes", "two", {}};
    PlotLine divided{"cubes that the bake divided", "three", {}};
    std::vector<PlotColumn> bytes;
    const auto work = divided_per_level();
    for (size_t k = 0; k < stats_.levels.size(); ++k) {
      const LevelStats& level = stats_.levels[k];
      svo.values.push_back(level.svo_nodes);
      dag.values.push_back(level.dag_nodes);
      divided.values.push_back(k < work.size() ? work[k] : 0);
      bytes.push_back({double(level.bytes), short_count(level.bytes)});
    }
    std::vector<PlotLine> lines = {svo, dag};
    if (baked()) lines.push_back(divided);
    out_ += "<h2>Levels</h2>\n<div class=\"plots\">\n" + plot_lines("Nodes per level", lines) +
            plot_columns("Bytes per level", bytes) + "</div>\n";
    level_table();
  }

  // The layers with most voxels, in their colours.
  void legend() {
    constexpr size_t kMost = 50;
    std::vector<Layer> layers = file_.layers().layers;
    std::ranges::stable_sort(layers, std::ranges::greater(), &Layer::voxels);
    begin_facts("Layers");
    for (const Layer& layer : std::span(layers).first(std::min(layers.size(), kMost))) {
      const auto& [r, g, b] = layer.colour;
      row("<span style=\"background:rgb(" + std::to_string(r) + "," + std::to_string(g) + "," +
              std::to_string(b) + ")\">&emsp;</span> " + escaped(shown_layer(layer.name)),
          format_count(layer.voxels) + " voxels");
    }
    end_table();
    if (layers.size() > kMost)
      out_ += "<p class=\"dim\">And " + format_count(layers.size() - kMost) + " more.</p>\n";
  }

  void level_table() {
    out_ +=
        "<p></p><div class=\"card\"><table>\n<tr><th class=\"n\">level<th "
        "class=\"n\">octree nodes<th class=\"n\">DAG nodes<th class=\"n\">shared by<th "
        "class=\"n\">bytes\n";
    for (size_t k = 0; k < stats_.levels.size(); ++k) {
      const LevelStats& level = stats_.levels[k];
      const double shared =
          double(level.svo_nodes) / double(std::max<uint64_t>(level.dag_nodes, 1));
      out_ += "<tr><td class=\"n\">" + std::to_string(k) + "<td class=\"n\">" +
              format_count(level.svo_nodes) + "<td class=\"n\">" + format_count(level.dag_nodes) +
              "<td class=\"n\">" + formatted(shared < 99.5 ? "%.1f" : "%.0f", shared) +
              "<td class=\"n\">" + format_count(level.bytes) + "\n";
    }
    end_table();
    out_ += "<p class=\"dim\">The last level holds bricks of 4&times;4&times;4 voxels.</p>\n";
  }

  // Time and memory per phase.
  void work() {
    const Json& seconds = bake_.at("seconds");
    const Json& memory = bake_.at("memory");
    const double total = std::max(seconds.at("total").get<double>(), 1e-9);
    const auto counted = whole_number<uint64_t>(memory.at("peak_counted"));
    std::vector<PlotBar> times, peaks;
    for (const auto& [phase, bytes] : memory.at("phases").items()) {
      const double value = seconds.at(phase).get<double>();
      times.push_back({phase, value, formatted("%.2f s", value)});
      peaks.push_back({phase, bytes.get<double>(), format_bytes(whole_number<uint64_t>(bytes))});
    }
    out_ += "<h2>Time and memory</h2>\n<div class=\"plots\">\n" +
            plot_bars("Seconds per phase", times, total, "one") +
            plot_bars("Peak memory per phase", peaks, double(counted), "two") + "</div>\n";
    out_ += "<p class=\"dim\">" + formatted("%.2f", total) + " seconds in all, " +
            formatted("%.2f", seconds.at("cpu").get<double>()) + " of processor time, on " +
            std::to_string(count("threads")) + " threads with " +
            escaped(bake_.at("vectors").get<std::string>()) + ". Memory: " + format_bytes(counted) +
            " peak counted, " + format_bytes(whole_number<uint64_t>(memory.at("peak_resident"))) +
            " resident. Scratch on disk: " +
            format_bytes(whole_number<uint64_t>(bake_.at("scratch").at("peak"))) +
            " at most.</p>\n";
  }

  void skipped() {
    const Json& memo = bake_.at("plane_memo");
    const auto queries = whole_number<uint64_t>(memo.at("asked")),
               answered = whole_number<uint64_t>(memo.at("answered"));
    const auto work = divided_per_level();
    const uint64_t grid_cells = uint64_t(1) << (3 * cell_level()), cells = count("cells");
    uint64_t octree = 0, divided = 0;
    for (size_t k = cell_level(); k + 1 < stats_.levels.size() && k < work.size(); ++k) {
      octree += stats_.levels[k].svo_nodes;
      divided += work[k];
    }
    const double empty = 1 - share_of(cells, grid_cells), undivided = 1 - share_of(divided, octree);
    std::vector<PlotBar> bars = {{"cells without a triangle", empty, percent(empty)},
                                 {"octree nodes never divided", octree == 0 ? 0 : undivided,
                                  percent(octree == 0 ? 0 : undivided)},
                                 {"cubes on one plane, not descended", share_of(answered, queries),
                                  percent(share_of(answered, queries))}};
    if (count("cache_hits") > 0)
      bars.push_back({"cells from the cache", share_of(count("cache_hits"), cells),
                      percent(share_of(count("cache_hits"), cells))});
    out_ += "<h2>Skipped work</h2>\n" + plot_bars("Skipped", bars, 1, "three");
    out_ += "<p class=\"dim\">Of " + format_count(grid_cells) + " cells, " + format_count(cells) +
            " were visited. Inside them the octree has " + format_count(octree) +
            " nodes above the bricks, and the bake divided " + format_count(divided) + " cubes. " +
            format_count(queries) + " cubes were looked up in the plane memo, which answered " +
            format_count(answered) + " and computed " +
            format_count(whole_number<uint64_t>(memo.at("computed"))) + " nodes for that.</p>\n";
  }

  const Json& bake_;
  const std::vector<Json>& verdicts_;
  const DagFile& file_;
  const DagStats& stats_;
  const IntegrityReport& integrity_;
  std::string out_;
};

// Parses an input that is about `file`.
Json parse_input(const ReportInput& input, const DagFile& file) {
  Json parsed = Json::parse(input.text, nullptr, false);
  if (!parsed.is_object() || !parsed.contains("content_hash"))
    fail_input(input.path, "is neither a report of svdag build nor a verdict of svdag-verify");
  if (parsed["content_hash"] != hash_of(file))
    fail_usage(input.path + ": is the report of another bake than " + file.path() +
               ": their content hashes differ");
  return parsed;
}

}  // namespace

ReportPage report_html(const std::vector<ReportInput>& inputs, const DagFile& file,
                       const DagStats& stats, const IntegrityReport& integrity,
                       const std::vector<ReportPicture>& pictures, const EmbeddedViewer& viewer) {
  Json bake;
  std::vector<Json> verdicts;
  std::string path = file.path();  // of the input that is used
  ReportPage page;
  page.ok = integrity.sound();
  try {
    for (const ReportInput& input : inputs) {
      path = input.path;
      Json parsed = parse_input(input, file);
      if (parsed.contains("command")) {
        page.ok = page.ok && is_ok(parsed);
        verdicts.push_back(std::move(parsed));
        Page(Json(), {verdicts.back()}, file, stats, integrity).make({});  // complete?
      } else {
        if (!bake.is_null()) fail_usage(path + ": is a second report of the bake: give one");
        bake = std::move(parsed);
        Page(bake, {}, file, stats, integrity).make({});
      }
    }
    page.html = Page(bake, verdicts, file, stats, integrity).make(pictures, viewer);
  } catch (const Json::exception&) {
    fail_input(
        path, "is not a report of svdag build or a verdict of svdag-verify, or of another version");
  } catch (const Error& error) {
    if (!error.path().empty() || error.code() == ExitCode::kUsage) throw;
    fail_input(path, error.what());
  }
  return page;
}

}  // namespace svdag
