#include "io/scene/decoders/image_means.h"

#include "streaming/error.h"

namespace svdag {

std::optional<ImageMean> ImageMeans::mean(const std::string& name, const Read& read) {
  const auto [known, is_new] = means_.try_emplace(name);
  if (!is_new) return known->second;
  try {
    MemoryBudget::Reservation memory;
    const std::vector<std::byte> bytes = read(&memory);
    known->second = mean_of_image({bytes, name, sandbox_}, budget_);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    notes_.push_back(error.what());
  }
  return known->second;
}

std::optional<ImageMean> ImageMeans::mean_of_file(const std::string& path) {
  return mean(path, [&](MemoryBudget::Reservation* memory) {
    return bytes_of(File::open_read(path), memory);
  });
}

std::vector<std::byte> ImageMeans::bytes_of(const File& file,
                                            MemoryBudget::Reservation* memory) const {
  check_image_bytes(file.size(), file.path());
  *memory = budget_->reserve(file.size(), "textures");
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  return bytes;
}

}  // namespace svdag
