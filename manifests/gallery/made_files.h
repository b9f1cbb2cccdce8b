// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/gallery/columns.h"
#include "manifests/gallery/made_record.h"
#include "manifests/manifest.h"
#include "manifests/whole_folder.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ds {

/// "00/00042": names of an image's files, by its place in the manifest.
std::string gallery_file_stem(std::size_t image);

/// What was made of the dataset's files.
struct MadeFiles {
  std::vector<ImageExtras> extras;                 ///< one an image
  std::vector<std::vector<std::string>> previews;  ///< one an image: kinds of which there is one
  std::vector<std::size_t> broken;                 ///< images of which a file cannot be shown
  MadeRecord record;
  std::uint64_t made = 0, reused = 0, bytes = 0;
};

/// What stands in a gallery, where all that would be made is there under its name, whole and of the sources
/// as they are now; `broken` are those of which a file that the page shows as it is is gone.
std::optional<MadeFiles> standing_gallery_files(const std::filesystem::path& dataset,
                                                const std::filesystem::path& gallery,
                                                const std::vector<ImageRecord>& images);

/// Writes thumbnails and previews into the folder, on all processors; those of the gallery that it
/// replaces are taken over where their source has the hash it had. A file that is missing, damaged or
/// not the manifest's makes its image `broken`, and nothing else. `done`: images so far; it may throw.
MadeFiles make_gallery_files(const std::filesystem::path& dataset,
                             const std::vector<ImageRecord>& images, WholeFolder& to,
                             const std::function<void(std::uint64_t)>& done);

}  // namespace ds
