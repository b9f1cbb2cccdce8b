// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/plan.h"
#include "manifests/concerns.h"
#include "manifests/manifest.h"
#include "tracer/base/kept.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace ds {

/// What of an image that a manifest lists is counted for the dataset as a whole. Views what others
/// hold.
struct ImageFacts {
  std::string_view id, model, class_path, split;
  std::uint64_t pixels = 0;  ///< width times height
  PixelCounts counts{};
  const ImageSpec* spec = nullptr;  ///< as the plan has it; none for a line of an earlier build
};

/// Every kind of Concern, counted for the images that a manifest lists; `planned` is
/// Plan::concerns. A class or split that an image of `pending` is of, which is to come, is not empty.
std::vector<Concern> dataset_concerns(const Recipe& recipe, const std::vector<Concern>& planned,
                                      const std::vector<ImageFacts>& images,
                                      const std::vector<const ImageSpec*>& pending = {});

/// Counts the pixels of an image's files, read from the dataset's folder, where the dsbuild that
/// made them did not, and keeps the counts in the database: once for each image. How many are
/// clipped the picture does not tell any more: `white` stays absent.
void count_older_pixels(ImageRecord& record, const PlannedImage& image,
                        const std::filesystem::path& folder, Database& database);

/// Counts what of its model an image cuts off (count_beyond), where that is not known yet, and tells it of each
/// distractor. Keeps the models that were read last.
class BeyondCounter {
 public:
  /// Writes what reading models told into the database, so that it need not be read again.
  void remember(Database& database);
  /// Nothing where the model cannot be read any more, which is warned of.
  void count(ImageRecord& record, const PlannedImage& image);

 private:
  struct ReadMesh {
    FileMesh mesh;
    friend std::size_t bytes_held(const ReadMesh& read) {
      return read.mesh.positions.size() * sizeof(Vec3d) +
             read.mesh.triangles.size() * sizeof(read.mesh.triangles[0]) + sizeof read;
    }
  };
  const FileMesh& mesh_of(const ModelPose& pose, const std::filesystem::path& file);
  void tell_objects(ImageRecord& record, const ImageSpec& image);

  Kept<ReadMesh> meshes_{std::size_t{128} << 20U};
  std::shared_ptr<const ReadMesh> last_;
  std::vector<std::pair<Hash128, PixelCounts>> found_;  ///< by product
};

}  // namespace ds
