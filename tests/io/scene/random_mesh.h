// Random meshes of polygons, written in every form that a reader takes.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace svdag {

struct RandomMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::vector<uint32_t>> faces;

  // Faces of 0 to 9 corners, mostly triangles; concave ones, crossed ones, repeated corners.
  RandomMesh(std::mt19937_64& random, uint32_t vertex_count, size_t face_count) {
    for (uint32_t i = 0; i < vertex_count; ++i)
      vertices.push_back({float(random() % 1024) / 8, -float(random() % 9999) / 7, float(i)});
    for (size_t f = 0; f < face_count; ++f) {
      const size_t corners = random() % 3 != 0 ? 3 : random() % 10;
      const uint32_t near = uint32_t(random() % vertex_count);
      const uint32_t reach = random() % 2 == 0 ? vertex_count : 16;
      std::vector<uint32_t> face;
      for (size_t c = 0; c < corners; ++c)
        face.push_back((near + uint32_t(random() % reach)) % vertex_count);
      faces.push_back(std::move(face));
    }
  }

  // `form`: "ascii", "binary_little_endian" or "binary_big_endian"; every choice below is random.
  std::string ply(std::mt19937_64& random, const std::string& form) const {
    const std::string type = std::array{"float", "double", "short"}[random() % 3];
    const bool strips = random() % 4 == 0, flag = random() % 2 == 0;
    const std::string vertex_head = "element vertex " + std::to_string(vertices.size()) +
                                    "\nproperty " + type + " x\nproperty " + type +
                                    " y\nproperty " + type + " z\n" +
                                    (flag ? "property uchar q\n" : "");
    const std::string face_head =
        std::string("element ") + (strips ? "tristrips " : "face ") + std::to_string(faces.size()) +
        "\nproperty list uchar int vertex_indices\n" + (flag ? "property short s\n" : "");
    const std::string begin = "ply\nformat " + form + " 1.0\n", end = "end_header\n";
    std::string vertex_rows, face_rows;
    for (const auto& v : vertices) {
      for (const float x : v) put(form, type, x, &vertex_rows);
      if (flag) put(form, "uchar", 200, &vertex_rows);
      if (form == "ascii") vertex_rows += '\n';
    }
    for (const auto& face : faces) {
      put(form, "uchar", double(face.size()), &face_rows);
      for (const uint32_t i : face)
        put(form, "int", strips && random() % 9 == 0 ? -1 : double(i), &face_rows);
      if (flag) put(form, "short", -3, &face_rows);
      if (form == "ascii") face_rows += '\n';
    }
    if (random() % 3 == 0) return begin + face_head + vertex_head + end + face_rows + vertex_rows;
    return begin + vertex_head + face_head + end + vertex_rows + face_rows;
  }

  std::string off() const {
    std::string text = "OFF # by chance\n" + std::to_string(vertices.size()) + " " +
                       std::to_string(faces.size()) + " 0\n";
    for (const auto& v : vertices) text += words(v) + "\n";
    for (const auto& face : faces) {
      text += std::to_string(face.size());
      for (const uint32_t i : face) text += " " + std::to_string(i);
      text += " 0.5 0.5 0.5\n";
    }
    return text;
  }

  // Vertices stand anywhere before the first face that uses them; a face counts from either end.
  std::string obj(std::mt19937_64& random) const {
    std::string text;
    uint32_t written = 0;
    const auto vertices_to = [&](uint32_t end) {
      for (; written < end; ++written)
        text += (random() % 8 == 0 ? "v\t" : "v ") + words(vertices[written]) +
                std::array{"\n", "\r\n", " 0.5 1 0\n", " # end \\\n", " \\\n1\n"}[random() % 5];
    };
    for (const auto& face : faces) {
      if (random() % 20 == 0)
        text += std::array{"g roof tiles\n", "g wall\n", "o house\n",     "g hidden\n",
                           "s off\n",        "vt 0 1\n", "usemtl brick\n"}[random() % 7];
      if (random() % 4 == 0) vertices_to(std::min(written + 9, uint32_t(vertices.size())));
      for (const uint32_t i : face) vertices_to(std::max(written, i + 1));
      text += random() % 8 == 0 ? "f\t" : "f ";
      for (const uint32_t i : face) {
        const int64_t index = random() % 2 == 0 ? int64_t(i) + 1 : int64_t(i) - int64_t(written);
        text += std::to_string(index) + std::array{" ", "/7 ", "//-1 ", "/3/3 "}[random() % 4];
      }
      text += "\n";
    }
    vertices_to(uint32_t(vertices.size()));
    return text;
  }

 private:
  static std::string words(const std::array<float, 3>& v) {
    return std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]);
  }
  static void put(const std::string& form, const std::string& type, double value,
                  std::string* out) {
    if (form == "ascii") {
      const bool whole = type != "float" && type != "double";
      *out += (whole ? std::to_string(int64_t(value)) : std::to_string(value)) + " ";
      return;
    }
    const bool big = form == "binary_big_endian";
    if (type == "float") append(float(value), big, out);
    if (type == "double") append(value, big, out);
    if (type == "short") append(int16_t(value), big, out);
    if (type == "int") append(int32_t(value), big, out);
    if (type == "uchar") append(uint8_t(value), big, out);
  }
  template <class T>
  static void append(T value, bool big, std::string* out) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) {
      out->append(bytes.rbegin(), bytes.rend());
    } else {
      out->append(bytes.begin(), bytes.end());
    }
  }
};

}  // namespace svdag
