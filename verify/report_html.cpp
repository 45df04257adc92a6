#include "verify/report_html.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/units.h"
#include "streaming/checksum.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #8884; --bar: #4a86c5; --soft: #8882; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.verdict { padding: .6rem 1rem; border-radius: .4rem; border-left: .4rem solid; background: var(--soft); }
.good { border-color: #2e8b57; } .bad { border-color: #c0392b; } .note { border-color: #d9a400; }
table { border-collapse: collapse; width: 100%; } td, th { padding: .2rem .6rem; border-bottom: 1px solid var(--line); }
th { text-align: left; font-weight: 600; } td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
td.bar { width: 40%; } td.bar div { background: var(--bar); height: .8rem; border-radius: .2rem; min-width: 1px; }
figure { margin: 0; } figure img { width: 100%; border-radius: .4rem; background: var(--soft); }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1rem; }
figcaption, footer, .dim { color: #888; font-size: .9rem; } code { word-break: break-all; })";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(const std::vector<std::byte>& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? uint32_t(bytes[i + k]) : 0);
    for (int k = 0; k < 4; ++k)
      out += i + size_t(k) <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

class Page {
 public:
  Page(const Json& bake, const DagFile& file, const DagStats& stats,
       const IntegrityReport& integrity)
      : bake_(bake), file_(file), stats_(stats), integrity_(integrity) {}

  std::string make(const std::vector<ReportPicture>& pictures) {
    const std::string output = bake_.at("output").get<std::string>();
    const std::string name = escaped(output.substr(output.find_last_of('/') + 1));
    out_ =
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\"><title>" +
        name + "</title><style>" + kStyle + "</style>\n<h1>" + name + "</h1>\n";
    out_ += "<p class=\"dim\">" + format_resolution(file_.view().resolution()) + "<sup>3</sup>, " +
            format_count(stats_.voxels) + " voxels, " + format_count(stats_.dag_nodes()) +
            " DAG nodes, " + format_bytes(file_.header().file_bytes) + "</p>\n";
    verdict();
    show(pictures);
    source();
    accuracy();
    levels();
    seconds();
    skipped();
    out_ += "<footer><p>svdag " + escaped(bake_.at("svdag").get<std::string>()) +
            ". Content hash <code>" + hash() + "</code></p></footer></html>\n";
    return std::move(out_);
  }
  std::string hash() const {
    const Header& h = file_.header();
    return to_hex({h.content_hash[0], h.content_hash[1]});
  }

 private:
  uint64_t count(const char* key) const { return bake_.at(key).get<uint64_t>(); }
  double number(const char* key) const { return bake_.at(key).get<double>(); }

  void box(const char* kind, const std::string& text) {
    out_ += std::string("<p class=\"verdict ") + kind + "\">" + text + "</p>\n";
  }
  void begin_table(const std::string& title, const std::string& head = "") {
    out_ += "<h2>" + title + "</h2>\n<table>" + head + "\n";
  }
  void end_table() { out_ += "</table>\n"; }
  void row(const std::string& name, const std::string& value) {
    out_ += "<tr><th>" + name + "<td>" + value + "\n";
  }
  static std::string bar(double share) {
    return "<td class=\"bar\"><div style=\"width:" + format("%.1f", 100 * share) + "%\"></div>";
  }

  void verdict() {
    if (integrity_.sound()) {
      box("good", "Every checksum is right; the DAG is in canonical order and minimal.");
    } else {
      std::string text = "This file is not sound:";
      for (const std::string& defect : integrity_.defects) text += "<br>" + escaped(defect);
      box("bad", text);
    }
    if (count("triangles_invalid") > 0)
      box("note", format_count(count("triangles_invalid")) +
                      " triangles with NaN or infinite coordinates were dropped.");
    if (count("triangles_outside") + count("triangles_clipped") > 0)
      box("note", format_count(count("triangles_outside")) +
                      " triangles lie outside of the grid, " +
                      format_count(count("triangles_clipped")) + " reach out of it.");
    if (number("quantisation_voxels") > 0.5)
      box("note", "The scene's positions are quantised in steps of " +
                      format("%.3g", number("quantisation_voxels")) + " voxels.");
    if (stats_.voxels == 0) box("note", "No voxel is set.");
  }

  void show(const std::vector<ReportPicture>& pictures) {
    out_ += "<div class=\"pictures\">\n";
    for (const ReportPicture& picture : pictures)
      out_ += "<figure><img alt=\"" + escaped(picture.caption) + "\" src=\"data:image/png;base64," +
              base64(picture.png) + "\"><figcaption>" + escaped(picture.caption) +
              "</figcaption></figure>\n";
    out_ += "</div>\n";
  }

  void source() {
    const Grid grid = file_.grid();
    const Point corner = grid.corner();
    begin_table("What was baked");
    std::string scene;
    for (const Json& path : bake_.at("scene"))
      scene += (scene.empty() ? "" : "<br>") + escaped(path.get<std::string>());
    row("scene", scene);
    row("triangles", format_count(count("triangles")));
    row("rule", escaped(bake_.at("rule").get<std::string>()));
    row("voxel size", format_double(grid.voxel_size));
    row("corner",
        format_double(corner.x) + ", " + format_double(corner.y) + ", " + format_double(corner.z));
    row("voxels", format_count(stats_.voxels));
    row("bits per voxel", format("%.3g", number("bits_per_voxel")));
    row("as an octree without sharing", format_count(stats_.svo_nodes()) + " nodes");
    end_table();
  }

  void accuracy() {
    begin_table("Accuracy");
    row("largest move of a coordinate by the snap",
        format("%.3g voxel", number("largest_snap_voxels")));
    row("decisions", format_count(count("decisions")) + ", of which " +
                         format("%.3g", 100 * number("decisions_exact_share")) +
                         " % needed integers; all of them are exact");
    row("triangles of zero area", format_count(count("triangles_degenerate")));
    end_table();
  }

  void levels() {
    uint64_t most = 1;
    for (const LevelStats& level : stats_.levels) most = std::max(most, level.bytes);
    begin_table("Levels",
                "<tr><th class=\"n\">level<th class=\"n\">SVO nodes<th class=\"n\">DAG nodes"
                "<th class=\"n\">bytes<th>");
    for (size_t k = 0; k < stats_.levels.size(); ++k) {
      const LevelStats& level = stats_.levels[k];
      out_ += "<tr><td class=\"n\">" + std::to_string(k) + "<td class=\"n\">" +
              format_count(level.svo_nodes) + "<td class=\"n\">" + format_count(level.dag_nodes) +
              "<td class=\"n\">" + format_bytes(level.bytes) +
              bar(double(level.bytes) / double(most)) + "\n";
    }
    end_table();
  }

  void seconds() {
    const Json& seconds = bake_.at("seconds");
    const double total = std::max(seconds.at("total").get<double>(), 1e-9);
    begin_table("Seconds", "<tr><th>phase<th class=\"n\">seconds<th>");
    for (const auto& [phase, value] : seconds.items()) {
      if (phase == "total" || phase == "cpu") continue;
      out_ += "<tr><td>" + escaped(phase) + "<td class=\"n\">" +
              format("%.2f", value.get<double>()) +
              bar(std::min(value.get<double>() / total, 1.0)) + "\n";
    }
    out_ += "<tr><th>total<th class=\"n\">" + format("%.2f", total) + "<td>" +
            format("%.2f", seconds.at("cpu").get<double>()) + " CPU seconds on " +
            std::to_string(count("threads")) + " threads, " +
            escaped(bake_.at("vectors").get<std::string>()) + "\n";
    end_table();
    const Json& memory = bake_.at("memory");
    out_ += "<p class=\"dim\">Memory: " + format_bytes(memory.at("peak_resident").get<uint64_t>()) +
            " resident at most. Scratch: " +
            format_bytes(bake_.at("scratch").at("peak").get<uint64_t>()) + " at most.</p>\n";
  }

  void skipped() {
    const Json& memo = bake_.at("plane_memo");
    begin_table("What did not need to be done");
    const uint64_t cells = count("cells");
    row("cells visited", format_count(cells));
    if (count("cache_hits") > 0) row("cells found in the cache", format_count(count("cache_hits")));
    row("cubes put to the plane memo", format_count(memo.at("asked").get<uint64_t>()));
    row("answered without descending", format_count(memo.at("answered").get<uint64_t>()));
    row("nodes computed for that", format_count(memo.at("computed").get<uint64_t>()));
    end_table();
  }

  const Json& bake_;
  const DagFile& file_;
  const DagStats& stats_;
  const IntegrityReport& integrity_;
  std::string out_;
};

}  // namespace

std::string report_html(const std::string& bake, const std::string& path, const DagFile& file,
                        const DagStats& stats, const IntegrityReport& integrity,
                        const std::vector<ReportPicture>& pictures) {
  const Json json = Json::parse(bake, nullptr, false);
  if (!json.is_object() || !json.contains("content_hash"))
    fail_input(path, "is no report of svdag build");
  Page page(json, file, stats, integrity);
  if (json["content_hash"] != page.hash())
    fail_usage(path + ": is the report of another bake than " + file.path() +
               ": their content hashes differ");
  try {
    return page.make(pictures);
  } catch (const Json::exception&) {
    fail_input(path, "is no report of svdag build, or of another version");
  }
}

}  // namespace svdag
