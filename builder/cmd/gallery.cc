// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/gallery.h"

#include "builder/cmd/from_manifest.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <filesystem>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// -o, or "gallery" in the dataset's folder.
fs::path gallery_folder(const Arguments& arguments, const fs::path& dataset) {
  if (!arguments.gallery_folder.empty()) return arguments.gallery_folder;
  std::error_code error;
  if (fs::is_directory(dataset, error) && ::access(dataset.c_str(), W_OK) != 0)
    fail(ErrorKind::usage,
         "{}: may not be written to; wanted another folder for the gallery, -o DIR",
         dataset.string());
  return dataset / "gallery";
}

}  // namespace

int run_gallery(const Arguments& arguments) {
  const fs::path dataset = dataset_folder(arguments.request());
  GalleryRequest request{dataset, gallery_folder(arguments, dataset)};
  if (const std::string why =
          behind_recipe(arguments, "the gallery shows what the manifest lists").text;
      !why.empty())
    request.notes.push_back(why);
  const std::atomic<bool>& stop = stop_on_signal();
  const GalleryResult result = [&] {
    WorkProgress progress("images looked at");
    return write_gallery(
        request, [&](std::uint64_t done, std::uint64_t all) { progress(done, all); }, stop);
  }();
  for (const std::string& note : result.notes)
    warn(note);
  const std::string page = (request.to / "index.html").string();
  if (arguments.json)
    print_json({{"folder", request.to.string()},
                {"page", page},
                {"images", result.images},
                {"files", result.files},
                {"bytes", result.bytes},
                {"made", result.made},
                {"reused", result.reused},
                {"broken", result.broken},
                {"notes", result.notes}});
  else
    say(Stream::report, "{}: {} images, {} thumbnails and previews made, {} kept, {:.1f} MB\n",
        page, result.images, result.made, result.reused, static_cast<double>(result.bytes) / 1e6);
  return 0;
}

}  // namespace ds
