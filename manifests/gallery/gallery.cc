// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/gallery.h"

#include "manifests/gallery/gallery_data.h"
#include "manifests/gallery/gallery_page.h"
#include "manifests/gallery/made_files.h"
#include "manifests/whole_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_images = "manifest/images.jsonl";
constexpr const char* k_page = "index.html";

void check_request(const GalleryRequest& request) {
  std::error_code error;
  if (!fs::is_regular_file(request.folder / k_images, error))
    fail(ErrorKind::usage,
         "{}: wanted the folder of a dataset that dsbuild built, found no {} in it",
         request.folder.string(), k_images);
  check_outside(request.to, request.folder);
}

/// The same lines that the records come from.
std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  const std::string text = read_text_file(file);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

nlohmann::json conventions_of(const fs::path& folder) {
  const nlohmann::json dataset =
      nlohmann::json::parse(read_text_file(folder / "manifest/dataset.json"));
  const auto at = dataset.find("conventions");
  return at == dataset.end() ? nlohmann::json::object() : *at;
}

/// Why nobody sees some of the pictures; "" where all are seen.
std::string broken_text(const std::vector<std::size_t>& broken,
                        const std::vector<ImageRecord>& images) {
  if (broken.empty()) return "";
  return fmt::format(
      "{} image{} with a file that is missing or not what the manifest says, {}{}; dsbuild verify "
      "tells more",
      broken.size(), broken.size() == 1 ? "" : "s", images[broken.front()].id,
      broken.size() > 1 ? fmt::format(" and {} more", broken.size() - 1) : "");
}

using Files = std::vector<std::pair<std::string, std::string>>;  ///< paths and texts

/// All but thumbnails and previews; `facts.notes` gets what is broken.
Files texts_of(GalleryFacts& facts, const std::vector<std::string>& lines,
               const std::vector<ImageRecord>& images, const MadeFiles& made) {
  if (std::string text = broken_text(made.broken, images); !text.empty())
    facts.notes.push_back(std::move(text));
  Files files;
  write_gallery_data(
      facts, lines, images, made,
      [&](const std::string& path, std::string_view text) { files.emplace_back(path, text); });
  files.emplace_back(k_page, gallery_page(facts));
  files.emplace_back(k_gallery_folder.record, made.record.text());
  return files;
}

/// Whether the gallery at `place` has these and nothing else beside the thumbnails and previews of
/// `made`, which stand there.
bool stands(const fs::path& place, const Files& files, const MadeFiles& made) {
  const std::map<std::string, Hash128> sums =
      read_checksum_file(place / k_gallery_folder.checksums);
  if (sums.size() != files.size() + made.reused) return false;
  return std::all_of(files.begin(), files.end(), [&](const auto& file) {
    std::error_code error;
    const auto known = sums.find(file.first);
    return known != sums.end() && known->second == hash_text(file.second) &&
           fs::is_regular_file(place / file.first, error) &&
           content_hash(place / file.first) == known->second;
  });
}

GalleryResult result_of(const MadeFiles& made, const Files& files, const GalleryFacts& facts,
                        std::size_t images) {
  GalleryResult result{images,      files.size() + made.made + made.reused,
                       made.bytes,  made.made,
                       made.reused, made.broken.size(),
                       facts.notes};
  for (const auto& [path, text] : files)
    result.bytes += text.size();
  return result;
}

}  // namespace

GalleryResult write_gallery(const GalleryRequest& request,
                            const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                            const std::atomic<bool>& stop) {
  check_request(request);
  const CheckInput input{read_dataset_manifest(request.folder),
                         read_images_manifest(request.folder)};
  const std::vector<ImageRecord>& images = input.images;
  const std::vector<std::string> lines = lines_of(request.folder / k_images);
  if (lines.size() != images.size())
    fail(ErrorKind::asset, "{}: changed while it was read, as by a build under way",
         (request.folder / k_images).string());
  const fs::path place = checked_place(request.to, k_gallery_folder);
  GalleryFacts facts{input.dataset, conventions_of(request.folder),
                     real_place(request.folder).lexically_relative(place).generic_string(),
                     request.notes, worst_first(run_checks(input, {}))};
  // Of most datasets nothing has changed, and nothing is written.
  if (is_whole_folder(place, k_gallery_folder))
    if (const auto made = standing_gallery_files(request.folder, place, images)) {
      const Files files = texts_of(facts, lines, images, *made);
      if (stands(place, files, *made)) {
        remove_leftovers(place, k_gallery_folder);
        return result_of(*made, files, facts, images.size());
      }
    }

  WholeFolder to(place, k_gallery_folder);
  const auto stop_if_asked = [&] {
    if (stop) fail(ErrorKind::cancelled, "stopped; no gallery is written");
  };
  const MadeFiles made = make_gallery_files(request.folder, images, to, [&](std::uint64_t done) {
    stop_if_asked();
    progress(done, images.size());
  });
  const Files files = texts_of(facts, lines, images, made);
  for (const auto& [path, text] : files) {
    stop_if_asked();
    to.write(path, bytes_of(text));
  }
  to.commit();
  return result_of(made, files, facts, images.size());
}

}  // namespace ds
