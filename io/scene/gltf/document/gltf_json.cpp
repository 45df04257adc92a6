#include "io/scene/gltf/document/gltf_json.h"

#include <algorithm>
#include <array>
#include <istream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

using nlohmann::json;

constexpr int kMaxNesting = 256;
constexpr uint64_t kValueBytes = 64;  // a parsed value with its share of map and vector, measured
constexpr const char* kPurpose = "parsed glTF nodes";

// Lets the JSON parser read a part of a file through a window.
class WindowBuffer : public std::streambuf {
 public:
  WindowBuffer(const File& file, uint64_t begin, uint64_t end) : bytes_(file, begin, end) {}

 protected:
  int_type underflow() override {
    bytes_.skip(shown_);
    const auto window = bytes_.peek();
    shown_ = window.size();
    if (window.empty()) return traits_type::eof();
    // The get area requires char*, but nothing is put back into it.
    char* begin = const_cast<char*>(reinterpret_cast<const char*>(window.data()));
    setg(begin, begin, begin + window.size());
    return traits_type::to_int_type(*begin);
  }

 private:
  ByteStream bytes_;
  size_t shown_ = 0;
};

bool is_read(std::string_view key, GltfParts parts) {
  if (parts.all || (parts.animations && key == "animations")) return true;
  if (parts.images && (key == "textures" || key == "images" || key == "samplers")) return true;
  constexpr std::array<std::string_view, 12> kKeys = {
      "asset",       "scene",   "scenes",
      "nodes",       "meshes",  "accessors",
      "bufferViews", "buffers", "extensionsRequired",
      "materials",   "skins",   "extensions"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

// Receives the parser's events (nlohmann::json_sax) and builds the tree.
class TreeBuilder {
 public:
  TreeBuilder(const File& file, uint64_t text_bytes, GltfParts parts,
              MemoryBudget::Reservation* memory)
      : path_(file.path()), parts_(parts), used_(text_bytes), memory_(memory) {
    // The longest string may pass through the parser's token buffer.
    memory_->resize(used_, kPurpose);
  }

  bool null() { return value(nullptr); }
  bool boolean(bool v) { return value(v); }
  bool number_integer(json::number_integer_t v) { return value(v); }
  bool number_unsigned(json::number_unsigned_t v) { return value(v); }
  bool number_float(json::number_float_t v, const std::string&) { return value(v); }
  bool string(const std::string& v) { return value(v, v.size()); }
  bool binary(const json::binary_t&) { return true; }  // not in text
  bool start_object(size_t) { return start(json::value_t::object); }
  bool start_array(size_t) { return start(json::value_t::array); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  // The member of that name, for the value that follows; the later of two.
  bool key(const std::string& name) {
    if (depth_ == 1) skipping_ = !is_read(name, parts_);
    note(name.size());
    if (!skipping_) member_ = &open_.back()->get_ref<json::object_t&>()[name];
    return true;
  }
  template <class Exception>
  [[noreturn]] bool parse_error(size_t, const std::string&, const Exception& error) {
    throw error;
  }

  json take() { return std::move(root_); }

 private:
  template <class Value>
  bool value(const Value& v, size_t bytes = 0) {
    note(bytes);
    if (!skipping_) place(v);
    return true;
  }
  bool start(json::value_t type) {
    note();
    ++depth_;
    if (!skipping_) open_.push_back(&place(type));
    return true;
  }
  bool end() {
    --depth_;
    const bool skipped = skipping_ && depth_ > 0;
    if (!skipped) open_.pop_back();
    note();
    return true;
  }

  template <class Value>
  json& place(const Value& v) {
    if (open_.empty()) return root_ = v;
    if (!open_.back()->is_array()) return *member_ = v;
    return open_.back()->get_ref<json::array_t&>().emplace_back(v);
  }

  // Called for every event, with the value that it adds.
  void note(size_t bytes = 0) {
    if (depth_ > kMaxNesting) fail_input(path_, "nests its JSON too deeply");
    if (skipping_) return;
    used_ += kValueBytes + bytes;
    if (used_ > memory_->bytes()) memory_->resize(used_ + used_ / 4, kPurpose);
  }

  const std::string& path_;
  GltfParts parts_;
  uint64_t used_;
  MemoryBudget::Reservation* memory_;
  json root_;
  std::vector<json*> open_;  // the objects and arrays around the next value, without skipped ones
  json* member_ = nullptr;
  int depth_ = 0;          // of all objects and arrays around the next value
  bool skipping_ = false;  // inside a member of the root that does not concern geometry
};

}  // namespace

json parse_gltf_json(const File& file, uint64_t begin, uint64_t end, GltfParts parts,
                     MemoryBudget::Reservation* memory) {
  TreeBuilder tree(file, end - begin, parts, memory);
  WindowBuffer buffer(file, begin, end);
  std::istream text(&buffer);
  try {
    json::sax_parse(text, &tree);
  } catch (const json::parse_error& error) {
    fail_input(file.path(), "is not valid JSON", begin + error.byte);
  } catch (const json::exception&) {  // a number beyond the range of double
    fail_input(file.path(), "has a number in its JSON that is too large");
  }
  return tree.take();
}

}  // namespace svdag
