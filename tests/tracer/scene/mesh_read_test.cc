// SPDX-License-Identifier: Apache-2.0
#include "tests/tracer/scene/mesh_samples.h"
#include "tracer/base/files.h"
#include "tracer/scene/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

template <typename Position>
void expect_sound(const BasicMesh<Position>& mesh, const fs::path& file) {
  EXPECT_FALSE(mesh.triangles.empty()) << file;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t)
      ASSERT_LT(v, mesh.positions.size()) << file;
  for (const Position p : mesh.positions)
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << file;
  for (const Vec3 n : mesh.normals)
    ASSERT_NEAR(length(to_double(n)), 1, 1e-6) << file;
}

TEST(ReadModel, ReadsTheRealModels) {
  const std::vector<fs::path> files = files_in(DS_SOURCE_DIR "/../shared/data/psb/models");
  if (files.empty()) GTEST_SKIP() << "no ../shared/data/psb/models";
  EXPECT_EQ(files.size(), 72U);
  for (const fs::path& file : files) {
    const Model model = read_model(file);
    EXPECT_EQ(model.report.non_finite + model.report.out_of_range, 0U) << file;
    expect_sound(model.mesh, file);
    for (const Normals normals : {Normals::smooth, Normals::flat}) {
      NormaliseOptions options;
      options.normals = normals;
      const Mesh mesh = normalise(model.mesh, options);
      expect_sound(mesh, file);
      EXPECT_EQ(mesh.triangles.size(), model.report.triangles_kept);
      const auto [low, high] = std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                                                   [](Vec3 a, Vec3 b) { return a.z < b.z; });
      EXPECT_EQ(low->z, -0.0574F) << file;
      EXPECT_LE(high->z, 0.16F - 0.0574F + 1e-8F) << file;
    }
  }
}

TEST(ReadModel, SeedsOfTheFuzzTargetsAreReadOrRefused) {
  for (const MeshFormat* format : mesh_formats()) {
    const std::string_view ending = format->endings.substr(0, format->endings.find(' '));
    std::size_t good = 0, refused = 0;
    for (const fs::path& file :
         files_in(fs::path(DS_SOURCE_DIR "/tests/fuzz/corpus") / ending.substr(1))) {
      try {
        expect_sound(normalise(read_model(file).mesh, {}), file);
        ++good;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::asset) << file;
        ++refused;
      }
    }
    EXPECT_GT(good, 0U) << ending;
    EXPECT_GT(refused, 0U) << ending;
  }
}

TEST(ReadModel, GoesByTheContentNotTheName) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "tetra.ply";
  write_file_atomic(file, std::string_view(samples::k_tetra_off));
  samples::expect_tetra(read_model(file).mesh);
}

TEST(ReadModel, AMissingFileIsAnInputError) {
  try {
    read_model("/nowhere/model.ply");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_THAT(error.what(), testing::HasSubstr("/nowhere/model.ply"));
  }
}

TEST(ReadModel, NamesThePath) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "broken.off";
  write_file_atomic(file, std::string_view("OFF\n3 1 0\n0 0 0\n"));
  try {
    read_model(file);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(file.string() + ":4: cut off"));
  }
}

}  // namespace
}  // namespace ds
