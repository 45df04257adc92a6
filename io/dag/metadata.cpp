#include "io/dag/metadata.h"

#include "io/dag/dag_file.h"
#include "io/dag/grid_fields.h"
#include "io/grid.h"
#include "io/units.h"

namespace svdag {
namespace {

std::string json_list(std::initializer_list<std::string> items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "[" : ",") + item;
  return text + "]";
}

}  // namespace

std::string metadata_of(const Header& h) {
  const auto number = [](auto v) { return std::to_string(v); };
  const auto real = [](double v) { return format_double(v); };
  std::string nodes;
  for (uint32_t k = 0; k < h.section_count; ++k)
    nodes += (k ? "," : "[") + number(h.sections[k].nodes);
  const std::string transform =
      has_transform(h) ? ",\"transform\":[" + format_transform(grid_of(h).transform) + "]" : "";
  const std::string origin =
      Grid::Kind(h.grid_kind) == Grid::Kind::kOrigin
          ? ",\"origin\":" + json_list({real(h.origin[0]), real(h.origin[1]), real(h.origin[2])})
          : "";
  const std::string layout = Layout(h.layout) == Layout::kPlain ? "" : ",\"layout\":\"compact\"";
  const std::string layers = h.layer_kind == 0
                                 ? ""
                                 : ",\"layers\":{\"kind\":\"" +
                                       std::string(layer_kind_name(LayerKind(h.layer_kind))) +
                                       "\",\"count\":" + number(h.layer_count) +
                                       ",\"union\":" + (h.has_union ? "true" : "false") + "}";
  const std::string colours =
      has_colours(h) ? ",\"colours\":{\"level\":" + number(h.colour_level) +
                           ",\"error\":" + real(double(h.colour_error) / kColourErrorUnit) +
                           ",\"count\":" + number(h.colour_count) + "}"
                     : "";
  return "{\"format\":\"svdag\",\"version\":" + number(h.version) + layout +
         ",\"levels\":" + number(h.levels) + ",\"resolution\":" + number(1U << h.levels) +
         ",\"rule\":\"" + rule_name(Rule(h.rule)) + "\",\"fraction_bits\":" + number(h.fraction) +
         ",\"grid\":{\"kind\":\"" + kind_name(Grid::Kind(h.grid_kind)) +
         "\",\"corner\":" + json_list({real(h.corner[0]), real(h.corner[1]), real(h.corner[2])}) +
         ",\"voxel_size\":" + real(h.voxel_size) +
         ",\"k0\":" + json_list({number(h.k0[0]), number(h.k0[1]), number(h.k0[2])}) +
         ",\"bounded\":" + (h.bounded ? "true" : "false") + ",\"selection\":" +
         json_list({number(h.selection_min[0]), number(h.selection_min[1]),
                    number(h.selection_min[2]), number(h.selection_max[0]),
                    number(h.selection_max[1]), number(h.selection_max[2])}) +
         origin + transform + "},\"voxels\":" + number(h.voxels) + ",\"nodes\":" + nodes +
         "],\"largest_snap\":" + real(h.largest_snap) + layers + colours + "}\n";
}

}  // namespace svdag
