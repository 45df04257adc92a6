// Serializes triangle bins, layers, cut-outs and winding numbers in records: for the journal of a
// bake and the index of a plan.
#pragma once

#include <vector>

#include "builder/split/scene_layers.h"
#include "builder/split/triangle_bins.h"
#include "builder/winding/cell_windings.h"
#include "streaming/spill/record.h"

namespace svdag {

void put_stream(const SpillStream& stream, RecordWriter* out);
SpillStream get_stream(RecordReader* in);

void put_bins(const std::vector<TriangleBin>& bins, RecordWriter* out);
// Bins that are impossible in a grid with `levels` levels are an Error of the reader.
std::vector<TriangleBin> get_bins(RecordReader* in, int levels);

// Names and colours, in their order.
void put_layers(const SceneLayers& layers, RecordWriter* out);
SceneLayers get_layers(RecordReader* in);

// The materials that cut, their images included.
void put_cut_outs(const CutOuts& cut_outs, RecordWriter* out);
CutOuts get_cut_outs(RecordReader* in);

// The winding numbers of the cells of a grid; null: none.
void put_windings(const CellWindings* windings, RecordWriter* out);
std::shared_ptr<const CellWindings> get_windings(RecordReader* in, int levels);

}  // namespace svdag
