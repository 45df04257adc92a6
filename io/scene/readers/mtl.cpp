#include "io/scene/readers/mtl.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <set>

#include "io/scene/colours/used_mean.h"
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

// The files of an mtllib: its whole rest if that is one, since names may have spaces, else each
// word.
std::vector<std::string> named_files(const std::filesystem::path& folder, std::string_view rest) {
  std::vector<std::string> paths = {(folder / rest).string()};
  if (is_file(paths[0])) return paths;
  paths.clear();
  Words words(rest);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    paths.push_back((folder / word).string());
  return paths;
}

// The .mtl files, each once.
std::vector<std::string> mtl_paths(const File& obj) {
  std::vector<std::string> paths;
  const std::filesystem::path folder = std::filesystem::path(obj.path()).parent_path();
  for_each_line(obj, kHead, [&](std::string_view word, Words& words) {
    if (word != "mtllib") return;
    for (const std::string& path : named_files(folder, words.rest())) {
      if (is_file(path) && std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
    }
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

// The options of a texture, then its file name, which may have spaces in it.
MtlTexture texture_of(Words words) {
  MtlTexture texture;
  for (;;) {
    Words rest = words;
    const std::string_view option = words.next();
    const int arguments = option_arguments(option);
    if (arguments < 0) {
      texture.path = rest.rest();
      return texture;
    }
    const std::string_view word = arguments == 1 ? words.next() : "";
    for (int i = 0; arguments > 1 && i < arguments; ++i) {
      rest = words;
      const auto value = number(words.next());
      if (!value) {
        words = rest;
        break;
      }
      if (option == "-o" && i < 2) texture.offset[i] = *value;
      if (option == "-s" && i < 2) texture.scale[i] = *value;
    }
    if (option == "-clamp") texture.clamp = word == "on";
    const bool is_off = word == "off" && (option == "-blendu" || option == "-blendv");
    const bool is_channel = option == "-imfchan" && word != "m";
    if (option == "-t" || option == "-mm" || is_off || is_channel) texture.unknown = option;
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
      materials_.files.push_back(path);
      read(path);
    }
  }

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
      if (word == "d") material->dissolve = number(words.next()).value_or(material->dissolve);
      if (word == "map_Kd") set(texture_of(words), path, &material->texture);
      if (word == "map_d") set(texture_of(words), path, &material->mask);
    });
  }

  void set(MtlTexture texture, const std::string& mtl, std::unique_ptr<MtlTexture>* out) {
    if (texture.path.empty()) return;
    texture.path = texture_path(mtl, texture.path);
    texture.is_outside = !wants(texture.path);
    count(sizeof texture + texture.path.size());
    *out = std::make_unique<MtlTexture>(std::move(texture));
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
  MtlMaterials materials_{{}, {}, options_.budget->reserve(0, "materials of .mtl files")};
};

}  // namespace

MtlMaterials read_mtl(const File& obj, const MtlOptions& options) {
  return MtlReader(obj, options).take();
}

std::optional<Omission> unread_mtl(const File& obj, std::string_view name,
                                   const MtlMaterials& materials) {
  const std::filesystem::path folder = std::filesystem::path(obj.path()).parent_path();
  std::optional<Omission> unread;
  for (const std::string& path : named_files(folder, name)) {
    if (!is_file(path)) {
      unread = Omission::kMissingMaterials;
    } else if (std::ranges::find(materials.files, path) == materials.files.end()) {
      return Omission::kMaterialFiles;
    }
  }
  return unread;
}

const MtlTexture* cutting_texture(const std::string& name, const MtlMaterial& material,
                                  const NameFilter& names) {
  const bool is_named = names.cuts_out(name);  // in any case: it records matches
  if (material.mask) return material.mask.get();
  return is_named ? material.texture.get() : nullptr;
}

std::vector<std::string> mtl_files(const File& obj, const MtlOptions& options) {
  const MtlMaterials materials = read_mtl(obj, options);
  std::vector<std::string> paths = materials.files;
  std::set<std::string> textures;
  const auto add = [&](const MtlTexture* texture) {
    if (texture != nullptr && !texture->is_outside) textures.insert(texture->path);
  };
  for (const auto& [name, material] : materials.by_name) {
    if (options.colours) add(material.texture.get());
    if (options.cut_outs != nullptr) add(cutting_texture(name, material, *options.cut_outs));
  }
  std::copy_if(textures.begin(), textures.end(), std::back_inserter(paths), is_file);
  return paths;
}

std::optional<Colour> colour_of(const MtlMaterial& material, LinearImages* images) {
  if (!material.texture || material.texture->is_outside) return material.diffuse;
  constexpr double kLeastAlpha = 1;  // what is transparent has no say
  const auto image = images->image_of_file(material.texture->path, kLeastAlpha);
  if (!image) return material.diffuse;
  const std::optional<LinearColour> mean = UsedMean({image}).mean();
  if (!mean) return material.diffuse;
  const Colour kd = material.diffuse.value_or(Colour{255, 255, 255});
  const auto factor = [](uint8_t code) {
    return double(light_units(light_of(code))) / double(kWhiteUnits);
  };
  return mean->times({factor(kd.r), factor(kd.g), factor(kd.b)});
}

}  // namespace svdag
