#include "io/scene/readers/mtl.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kHead = size_t(1) << 16;
constexpr uint64_t kLargestMtl = uint64_t(64) << 20;

std::string text_of(const File& file, uint64_t most) {
  std::string text(size_t(std::min(file.size(), most)), '\0');
  text.resize(file.read_some_at(0, std::as_writable_bytes(std::span(text))));
  return text;
}

// The rest of a line after its first word, without spaces around it.
std::string rest_of(std::istringstream& line) {
  std::string rest;
  std::getline(line >> std::ws, rest);
  while (!rest.empty() && (rest.back() == '\r' || rest.back() == ' ' || rest.back() == '\t'))
    rest.pop_back();
  return rest;
}

// Calls visit(word, line) for each line, its first word read.
template <class Visit>
void for_each_line(const std::string& text, const Visit& visit) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    if (words >> word) visit(word, words);
  }
}

bool is_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::vector<std::string> mtl_paths(const File& obj) {
  std::vector<std::string> paths;
  const std::filesystem::path folder = std::filesystem::path(obj.path()).parent_path();
  for_each_line(text_of(obj, kHead), [&](const std::string& word, std::istringstream& line) {
    if (word != "mtllib") return;
    const std::string path = (folder / rest_of(line)).string();
    if (is_file(path)) paths.push_back(path);
  });
  return paths;
}

bool is_number(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// Arguments that an option of a texture takes, at most; -1: not an option. Optional ones are
// numbers.
int option_arguments(const std::string& word) {
  if (word == "-o" || word == "-s" || word == "-t") return 3;
  if (word == "-mm") return 2;
  for (const char* one : {"-blendu", "-blendv", "-boost", "-bm", "-cc", "-clamp", "-colorspace",
                          "-imfchan", "-texres", "-type"}) {
    if (word == one) return 1;
  }
  return -1;
}

// The file name of a texture: what follows its options, with spaces in it.
std::string texture_name(std::istringstream& line) {
  for (;;) {
    const auto begin = (line >> std::ws).tellg();
    std::string word;
    line >> word;
    int arguments = option_arguments(word);
    if (arguments < 0) {
      line.clear();
      line.seekg(begin);
      return begin < 0 ? "" : rest_of(line);
    }
    const bool numbers = arguments > 1;
    for (; arguments > 0; --arguments) {
      const auto next = (line >> std::ws).tellg();
      if (!(line >> word)) return "";
      if (!numbers || is_number(word)) continue;
      line.clear();
      line.seekg(next);
      break;
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

}  // namespace

std::map<std::string, MtlMaterial> read_mtl(const File& obj) {
  std::map<std::string, MtlMaterial> materials;
  for (const std::string& path : mtl_paths(obj)) {
    std::string name;
    for_each_line(text_of(File::open_read(path), kLargestMtl),
                  [&](const std::string& word, std::istringstream& line) {
                    double r = 0, g = 0, b = 0;
                    if (word == "newmtl") name = rest_of(line);
                    if (word == "Kd" && line >> r >> g >> b)
                      materials[name].diffuse = {colour_code(r), colour_code(g), colour_code(b)};
                    if (word != "map_Kd") return;
                    const std::string texture = texture_name(line);
                    if (!texture.empty()) materials[name].texture = texture_path(path, texture);
                  });
  }
  return materials;
}

std::vector<std::string> mtl_files(const File& obj) {
  std::vector<std::string> paths = mtl_paths(obj);
  std::set<std::string> textures;
  for (const auto& [name, material] : read_mtl(obj)) textures.insert(material.texture);
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
