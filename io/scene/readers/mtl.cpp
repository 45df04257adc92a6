#include "io/scene/readers/mtl.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <set>

#include "streaming/file/file_folder.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr uint64_t kHead = uint64_t(1) << 16;
constexpr uint64_t kLargestMtl = uint64_t(64) << 20;
constexpr size_t kLongestMtlLine = size_t(1) << 12;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// The words of a line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  // "" at the end.
  std::string_view next() {
    skip_blanks();
    const size_t size = size_t(std::ranges::find_if(rest_, is_blank) - rest_.begin());
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  // What is left, without blanks around it.
  std::string_view rest() {
    skip_blanks();
    while (!rest_.empty() && is_blank(rest_.back())) rest_.remove_suffix(1);
    return rest_;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

// Calls visit(first word, the others) for each line of the first `max_bytes` bytes. Of longer
// lines, only the beginning counts.
template <class Visit>
void for_each_line(const File& file, uint64_t max_bytes, const Visit& visit) {
  std::vector<char> block(kHead);
  std::string line;
  const auto end_line = [&] {
    Words words(line);
    const std::string_view first = words.next();
    visit(first, words);
    line.clear();
  };
  for (uint64_t at = 0, got = 0; at < max_bytes; at += got) {
    check_interrupt();
    got = file.read_some_at(at, std::as_writable_bytes(std::span(block)));
    if (got == 0) break;
    std::string_view text(block.data(), size_t(std::min(got, max_bytes - at)));
    for (size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
      line.append(text.substr(0, std::min(end, kLongestMtlLine)));
      end_line();
      text.remove_prefix(end + 1);
    }
    if (line.size() < kLongestMtlLine) line.append(text.substr(0, kLongestMtlLine));
  }
  end_line();
}

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

// The .mtl files, each once.
std::vector<std::string> mtl_paths(const File& obj) {
  std::vector<std::string> paths;
  const std::filesystem::path folder = std::filesystem::path(obj.path()).parent_path();
  for_each_line(obj, kHead, [&](std::string_view word, Words& words) {
    if (word != "mtllib") return;
    const std::string path = (folder / words.rest()).string();
    if (is_file(path) && std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
  });
  return paths;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  return whole ? std::optional(value) : std::nullopt;
}

std::optional<Colour> colour(Words words) {
  const auto r = number(words.next()), g = number(words.next()), b = number(words.next());
  if (!r || !g || !b) return {};
  return Colour{colour_code(*r), colour_code(*g), colour_code(*b)};
}

// Arguments that an option of a texture takes, at most; -1: not an option. Optional ones are
// numbers.
int option_arguments(std::string_view word) {
  if (word == "-o" || word == "-s" || word == "-t") return 3;
  if (word == "-mm") return 2;
  for (const char* one : {"-blendu", "-blendv", "-boost", "-bm", "-cc", "-clamp", "-colorspace",
                          "-imfchan", "-texres", "-type"}) {
    if (word == one) return 1;
  }
  return -1;
}

// The file name of a texture: what follows its options, with spaces in it.
std::string_view texture_name(Words words) {
  for (;;) {
    Words rest = words;
    int arguments = option_arguments(words.next());
    if (arguments < 0) return rest.rest();
    const bool numbers = arguments > 1;
    for (; arguments > 0; --arguments) {
      rest = words;
      if (numbers && !number(words.next())) {
        words = rest;
        break;
      }
      if (!numbers) words.next();
    }
  }
}

// Beside the .mtl file. Those of Windows separate folders by backslashes.
std::string texture_path(const std::string& mtl, std::string name) {
  const std::filesystem::path folder = std::filesystem::path(mtl).parent_path();
  std::string path = (folder / name).string();
  if (is_file(path)) return path;
  std::replace(name.begin(), name.end(), '\\', '/');
  return (folder / name).string();
}

class MtlReader {
 public:
  MtlReader(const File& obj, const MtlOptions& options) : options_(options), path_(obj.path()) {
    for (const std::string& path : mtl_paths(obj)) {
      if (!wants(path)) continue;
      files_.push_back(path);
      read(path);
    }
  }

  const std::vector<std::string>& files() const { return files_; }
  MtlMaterials take() { return std::move(materials_); }

 private:
  // A file that does not exist is an Error where it is opened.
  bool wants(const std::string& path) const {
    if (options_.allow_outside || !is_file(path) || is_inside(folder_of(path_), path)) return true;
    if (options_.images != nullptr)
      options_.images->note(path +
                            ": is outside the folder of the scene: --allow-outside reads it");
    return false;
  }

  void read(const std::string& path) {
    MtlMaterial* material = &named("");
    for_each_line(File::open_read(path), kLargestMtl, [&](std::string_view word, Words& words) {
      if (word == "newmtl") material = &named(words.rest());
      if (word == "Kd") {
        if (const auto diffuse = colour(words)) material->diffuse = diffuse;
      }
      if (word != "map_Kd") return;
      const std::string_view name = texture_name(words);
      if (name.empty()) return;
      std::string texture = texture_path(path, std::string(name));
      if (!wants(texture)) return;
      count(texture.size());
      material->texture = std::move(texture);
    });
  }

  MtlMaterial& named(std::string_view name) {
    const auto [at, is_new] = materials_.by_name.try_emplace(std::string(name));
    if (is_new) count(name.size() + sizeof *at + 4 * sizeof(void*));
    return at->second;
  }
  void count(uint64_t bytes) {
    MemoryBudget::Reservation& memory = materials_.memory;
    memory.resize(memory.bytes() + bytes, "materials of .mtl files");
  }

  const MtlOptions& options_;
  const std::string& path_;  // of the .obj file
  std::vector<std::string> files_;
  MtlMaterials materials_{{}, options_.budget->reserve(0, "materials of .mtl files")};
};

}  // namespace

MtlMaterials read_mtl(const File& obj, const MtlOptions& options) {
  return MtlReader(obj, options).take();
}

std::vector<std::string> mtl_files(const File& obj, const MtlOptions& options) {
  MtlReader reader(obj, options);
  std::vector<std::string> paths = reader.files();
  std::set<std::string> textures;
  for (const auto& [name, material] : reader.take().by_name) textures.insert(material.texture);
  std::copy_if(textures.begin(), textures.end(), std::back_inserter(paths), is_file);
  return paths;
}

std::optional<Colour> colour_of(const MtlMaterial& material, ImageMeans* images) {
  if (material.texture.empty()) return material.diffuse;
  const std::optional<ImageMean> mean = images->mean_of_file(material.texture);
  if (!mean) return material.diffuse;
  const Colour kd = material.diffuse.value_or(Colour{255, 255, 255});
  const auto factor = [](uint8_t code) {
    return double(light_units(light_of(code))) / double(kWhiteUnits);
  };
  return mean->visible.times({factor(kd.r), factor(kd.g), factor(kd.b)});
}

}  // namespace svdag
