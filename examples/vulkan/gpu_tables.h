// The words that svdag_layer() and svdag_colour() of shaders/svdag.glsl read besides the file. Word k < 19 is the
// position of a table among them: 0 that of the layers, k the counts of colours of level k.
#pragma once

#include <svdag/io/dag/colours/dag_colours.h>

#include <vector>

inline std::vector<uint32_t> gpu_tables(const svdag::DagFile& file) {
  std::vector<uint32_t> words(svdag::kMaxSections);
  if (!file.layers().layers.empty()) {
    const svdag::LayerIndex index = file.layer_index();
    words[0] = uint32_t(words.size());
    words.push_back(index.view().level);
    words.insert(words.end(), index.begin().begin(), index.begin().end());
    for (const auto& entry : index.entries()) words.insert(words.end(), {entry.layer, entry.node});
  }
  if (file.has_colours()) {
    svdag::MemoryBudget memory;
    const svdag::DagColours colours(file, &memory);
    for (uint32_t k = 1; k < svdag::kMaxSections; ++k) {
      const svdag::LevelCounts& counts = colours.view().counts.levels[k];
      if (counts.counts == nullptr) continue;
      words[k] = uint32_t(words.size());
      const auto end = svdag::ColourCounts::slot(file.layout(), file.view().index_end[k]);
      for (uint64_t i = 0; i < end; ++i) words.push_back(uint32_t(counts[i]));
    }
  }
  return words;
}
