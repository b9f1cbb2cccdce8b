// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/scene/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace ds::samples {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// A box as quads, counter-clockwise seen from outside.
inline std::string box_off(double x, double y, double z, const char* keyword = "OFF") {
  return fmt::format(
      "{0}\n8 6 12\n0 0 0\n{1} 0 0\n{1} {2} 0\n0 {2} 0\n0 0 {3}\n{1} 0 {3}\n{1} {2} {3}\n0 {2} "
      "{3}\n"
      "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
      keyword, x, y, z);
}

/// Corners (0,0,0) (4,0,0) (0,4,0) (0,0,4), faces seen from outside.
inline const std::vector<Vec3d> k_tetra_positions{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
inline const Triangles k_tetra_triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

inline const char* const k_tetra_off =
    "OFF\n4 4 6\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

inline const char* const k_tetra_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

inline const char* const k_tetra_obj =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

inline const char* const k_tetra_stl =
    "solid tetra\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 4 0\nvertex 4 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 0 0 4\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 4\nvertex 0 4 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 4 0 0\nvertex 0 4 0\nvertex 0 0 4\nendloop\nendfacet\n"
    "endsolid tetra\n";

inline void expect_tetra(const FileMesh& mesh) {
  EXPECT_EQ(mesh.positions, k_tetra_positions);
  EXPECT_EQ(mesh.triangles, k_tetra_triangles);
}

/// The same, where vertices may be in another order.
inline void expect_tetra_corners(const FileMesh& mesh) {
  EXPECT_EQ(mesh.positions.size(), k_tetra_positions.size());
  ASSERT_EQ(mesh.triangles.size(), k_tetra_triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(mesh.positions[mesh.triangles[t][k]], k_tetra_positions[k_tetra_triangles[t][k]])
          << t << " " << k;
}

/// Appends the bytes of a value as `T` in the wanted order.
template <typename T>
void put(std::string& out, double value, std::endian order) {
  const T typed = static_cast<T>(value);
  char raw[sizeof(T)];
  std::memcpy(raw, &typed, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out += raw[order == std::endian::native ? i : sizeof(T) - 1 - i];
}

inline std::string tetra_binary_stl(std::string header) {
  header.resize(80, '\0');
  put<std::uint32_t>(header, 4, std::endian::little);
  for (const auto& t : k_tetra_triangles) {
    header += std::string(12, '\0');
    for (const std::uint32_t v : t)
      for (int axis = 0; axis < 3; ++axis)
        put<float>(header, k_tetra_positions[v][axis], std::endian::little);
    header += std::string(2, '\0');
  }
  return header;
}

/// `text` with each `from` replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// The message of the Error(asset) that reading `bytes` as "m" throws.
inline std::string error_of(std::string_view bytes) {
  try {
    parse_model(bytes, "m");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    return error.what();
  }
  ADD_FAILURE() << "read without an error";
  return {};
}

}  // namespace ds::samples
