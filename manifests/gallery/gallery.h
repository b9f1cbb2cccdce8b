// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ds {

struct GalleryRequest {
  std::filesystem::path folder;  ///< of the dataset: its manifest and files are enough
  std::filesystem::path to;
  /// What readers must know of the dataset, as that its recipe wants more: shown in the page.
  std::vector<std::string> notes{};
};

struct GalleryResult {
  std::uint64_t images = 0, files = 0, bytes = 0;
  std::uint64_t made = 0, reused = 0;  ///< thumbnails and previews
  std::uint64_t broken = 0;            ///< images of which a file is missing or not the manifest's
  std::vector<std::string> notes;
};

/// Writes a folder of static files that shows the dataset in a browser, without a server:
///
///   index.html              the page: markup, style and program in one
///   data/meta.js            gallery.meta({...}): columns, counts, conventions, recipe
///   data/grid-0.js          gallery.grid(0, {"error": [...], ...}): columns of 5,000 images each
///   data/image-000.js       gallery.image(0, [...]): manifest lines of 100 images, loaded when one is opened
///   t/00/00042.jpg          thumbnail, at most 128 pixels long and wide
///   p/00/00042.depth.jpg    preview of a plane whose file no browser shows, at most 256
///   .dsbuild-gallery/       what was made of what, and checksums, for the next time
///
/// Pictures and masks stay in the dataset, and the page links to them. What is written depends on the
/// dataset's files, and on where they lie seen from the gallery, alone. A gallery that stands there is
/// replaced as a whole; of it thumbnails and previews are taken over whose source is as it was.
/// Throws Error(usage) for a folder without a manifest and a place that cannot be had. `progress`:
/// images done of all. Stopped, it throws Error(cancelled) and leaves nothing behind.
GalleryResult write_gallery(const GalleryRequest& request,
                            const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                            const std::atomic<bool>& stop);

}  // namespace ds
