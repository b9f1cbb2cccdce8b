// SPDX-License-Identifier: Apache-2.0
#include "builder/make/verify.h"

#include "builder/make/checksum_lines.h"
#include "builder/make/older_lines.h"
#include "builder/make/plane_outputs.h"
#include "builder/plan/image_scene.h"
#include "manifests/manifest_glance.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/parallel.h"
#include "tracer/render/develop.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_checksums = "manifest/checksums.xxh128";
constexpr const char* k_images_manifest = "manifest/images.jsonl";
const std::set<std::string> k_own_files{k_images_manifest, "manifest/dataset.json", k_checksums};

void check_file(VerifyResult& result, const fs::path& folder, const FileRecord& wanted) {
  const fs::path file = folder / wanted.path;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    result.findings.push_back({Finding::Kind::missing, wanted.path, "the file is missing", ""});
    return;
  }
  FileHashes found;
  try {
    found = hash_file(file);
  } catch (const Error& error_of_one) {
    result.findings.push_back({Finding::Kind::changed, wanted.path, error_of_one.what(), ""});
    return;
  }
  if (found.xxh128 == wanted.hashes.xxh128 && found.sha256 == wanted.hashes.sha256 &&
      found.size_bytes == wanted.hashes.size_bytes)
    return;
  const std::string bytes =
      fmt::format("wanted {} bytes with XXH3-128 {}, found {} with {}", wanted.hashes.size_bytes,
                  wanted.hashes.xxh128.hex(), found.size_bytes, found.xxh128.hex());
  try {
    if (pixel_hash(file) == wanted.pixels)
      result.findings.push_back(
          {Finding::Kind::encoding, wanted.path, "the pixels are the same", bytes});
    else
      result.findings.push_back({Finding::Kind::changed, wanted.path, "the pixels differ", bytes});
  } catch (const Error&) {
    result.findings.push_back(
        {Finding::Kind::changed, wanted.path, "it is no readable image", bytes});
  }
}

bool is_as_listed(const fs::path& folder, const FileRecord& wanted) {
  std::error_code error;
  if (!fs::is_regular_file(folder / wanted.path, error)) return false;
  try {
    const FileHashes found = hash_file(folder / wanted.path);
    return found.xxh128 == wanted.hashes.xxh128 && found.sha256 == wanted.hashes.sha256 &&
           found.size_bytes == wanted.hashes.size_bytes;
  } catch (const std::exception&) {
    return false;
  }
}

/// What a manifest lists.
struct Listed {
  std::uint64_t images = 0;
  std::vector<FileRecord> files;
};

/// Of the lines that stand there as a dsbuild wrote them: their files are all that is looked at.
Listed listed_at_glance(const std::string& text) {
  Listed listed;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    auto files = files_at_glance(line);
    const auto line_number = static_cast<int>(++listed.images);
    if (!files)
      files = image_from_json_line(std::string(line), k_images_manifest, line_number).files;
    for (FileRecord& one : *files) {
      check_manifest_path(one.path);
      listed.files.push_back(std::move(one));
    }
    at = end + 1;
  }
  return listed;
}

/// A manifest that its checksum bears out is as it was written, and need not be read whole: that costs ten times
/// as much as a glance. Throws as read_images_manifest.
Listed read_listed(const fs::path& folder,
                   const std::optional<std::map<std::string, Hash128>>& sums) {
  const fs::path file = folder / k_images_manifest;
  std::error_code error;
  const auto sum = sums ? sums->find(k_images_manifest) : decltype(sums->find("")){};
  if (sums && sum != sums->end() && fs::is_regular_file(file, error)) {
    const std::string text = read_text_file(file);
    if (hash_text(text) == sum->second && text.ends_with('\n')) return listed_at_glance(text);
  }
  Listed listed;
  for (ImageRecord& image : read_images_manifest(folder)) {
    ++listed.images;
    std::move(image.files.begin(), image.files.end(), std::back_inserter(listed.files));
  }
  return listed;
}

/// The files that are not what the manifest says, in its order. One thread a core: most of the time
/// goes into hashes.
std::vector<const FileRecord*> differing_files(const fs::path& folder,
                                               const std::vector<FileRecord>& files) {
  std::vector<char> as_listed(files.size());
  parallel_ranges(files.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      as_listed[i] = is_as_listed(folder, files[i]) ? 1 : 0;
  });
  std::vector<const FileRecord*> differing;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (as_listed[i] == 0) differing.push_back(&files[i]);
  return differing;
}

/// The checksum file against the manifest: it is what people without dsbuild check.
void check_checksums(VerifyResult& result, const fs::path& folder,
                     const std::map<std::string, Hash128>& listed,
                     const std::map<std::string, Hash128>& sums) {
  const auto add = [&](const std::string& path, const std::string& what) {
    result.findings.push_back({Finding::Kind::manifest, path, what, ""});
  };
  const std::string sums_file = k_checksums;
  std::error_code error;
  for (const auto& [path, hash] : listed) {
    const auto sum = sums.find(path);
    if (sum == sums.end())
      add(path, sums_file + " does not list it");
    else if (sum->second != hash)
      add(path, sums_file + " contradicts images.jsonl on it");
  }
  for (const auto& [path, hash] : sums) {
    if (listed.contains(path)) continue;
    if (!path.starts_with("manifest/"))
      add(path, sums_file + " lists it, and images.jsonl does not");
    else if (!fs::is_regular_file(folder / path, error))
      result.findings.push_back({Finding::Kind::missing, path, "the file is missing", ""});
    else if (content_hash(folder / path) != hash)
      add(path, "it has another checksum than " + sums_file + " says");
  }
}

/// The images to trace again: those of the least hashes, so that one seed chooses the same ones
/// everywhere.
std::vector<const PlannedImage*> choose(const Plan& plan, std::uint64_t count, std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, const PlannedImage*>> order;
  for (const PlannedImage& image : plan.images)
    order.emplace_back(hash64_text(fmt::format("rerender {} {}", seed, image.spec.id)), &image);
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first, a.second->spec.id) < std::tie(b.first, b.second->spec.id);
  });
  order.resize(std::min<std::uint64_t>(order.size(), count));
  std::vector<const PlannedImage*> chosen;
  for (const auto& [hash, image] : order)
    chosen.push_back(image);
  return chosen;
}

class Rerender {
 public:
  Rerender(const Recipe& recipe, Inputs& inputs, Renderer& renderer, const PlannedImage& image,
           const std::atomic<bool>& stop)
      : recipe_(recipe), inputs_(inputs), renderer_(renderer), image_(image), stop_(stop) {}

  std::vector<std::byte> encode(const OutputFile& output) {
    if (output.plane != nullptr && is_of_light(*output.plane)) {
      if (light_.planes.empty())
        light_ = renderer_.trace_light(image_.spec, wanted_light_planes(recipe_.outputs), nullptr,
                                       {}, stop_);
      if (!is_cut_out(recipe_.outputs, output))
        return encode_output(recipe_.outputs, output, light_.planes);
      return encode_cut_out(output, light_.planes, light_.film, tone_map());
    }
    if (output.plane == nullptr) {
      const Film film = renderer_.trace(image_.spec, nullptr, {}, stop_);
      return encode_png(develop(film, tone_map(), effects_of(image_.spec)).picture);
    }
    if (planes_.empty()) planes_ = renderer_.trace_planes(image_.spec, planes_of(recipe_.outputs));
    return encode_output(recipe_.outputs, output, planes_);
  }

 private:
  const ToneMap& tone_map() {
    return tone_map_of(recipe_, inputs_.environment(image_.spec.environment_folder));
  }

  const Recipe& recipe_;
  Inputs& inputs_;
  Renderer& renderer_;
  const PlannedImage& image_;
  const std::atomic<bool>& stop_;
  std::vector<Plane> planes_;
  LitPlanes light_;
};

void compare_rerendered(VerifyResult& result, Rerender& rerender, const PlannedImage& image,
                        const ImageRecord& record) {
  for (const FileRecord& wanted : record.files) {
    const auto output =
        std::find_if(image.keys.outputs.begin(), image.keys.outputs.end(),
                     [&](const OutputFile& one) { return one.kind == wanted.kind; });
    if (output == image.keys.outputs.end()) continue;  // the recipe wants it no more
    const std::vector<std::byte> bytes = rerender.encode(*output);
    const Hash128 found = hash_bytes(bytes);
    if (found == wanted.hashes.xxh128) continue;
    const bool same_pixels = pixel_hash(bytes, wanted.path) == wanted.pixels;
    result.findings.push_back(
        {Finding::Kind::rerender, wanted.path,
         same_pixels ? "traced again, the pixels are the same but the file's bytes differ"
                     : "traced again, the pixels differ",
         fmt::format("wanted XXH3-128 {}, found {}", wanted.hashes.xxh128.hex(), found.hex())});
  }
}

/// Of what `verify_files` has read whole.
struct RecordedKeys {
  Hash128 render, files;
};
std::map<std::string, RecordedKeys> keys_by_id(const fs::path& folder) {
  std::map<std::string, RecordedKeys> keys;
  OlderLines lines(folder, true);
  while (const OlderLine* line = lines.next())
    keys.emplace(line->glance.id, RecordedKeys{line->glance.render_key, line->glance.files_key});
  return keys;
}

std::map<std::string, ImageRecord> records_by_id(const fs::path& folder) {
  std::map<std::string, ImageRecord> records;
  for (ImageRecord& record : read_images_manifest(folder))
    records.emplace(record.id, std::move(record));
  return records;
}

}  // namespace

const char* to_string(Finding::Kind kind) {
  switch (kind) {
    case Finding::Kind::missing:
      return "missing";
    case Finding::Kind::extra:
      return "extra";
    case Finding::Kind::changed:
      return "changed";
    case Finding::Kind::encoding:
      return "encoding";
    case Finding::Kind::manifest:
      return "manifest";
    case Finding::Kind::rerender:
      return "rerender";
  }
  assertion_failed("a Finding::Kind", __FILE__, __LINE__);
}

std::string to_text(const Finding& finding) {
  return finding.detail.empty() ? finding.what
                                : fmt::format("{}; {}", finding.what, finding.detail);
}

VerifyResult verify_files(const fs::path& folder) {
  VerifyResult result, of_checksums;
  const auto sums = read_checksums(of_checksums, folder, k_checksums);
  const auto add_of_checksums = [&] {
    std::move(of_checksums.findings.begin(), of_checksums.findings.end(),
              std::back_inserter(result.findings));
  };
  Listed manifest;
  try {
    manifest = read_listed(folder, sums);
  } catch (const Error& error) {
    std::error_code ignored;
    if (!fs::is_regular_file(folder / k_images_manifest, ignored)) throw;
    result.has_manifest = false;
    result.findings.push_back({Finding::Kind::manifest, k_images_manifest, error.what(), ""});
    add_of_checksums();
    if (sums) {
      compare_with_checksums(result, folder, *sums, k_own_files, k_checksums);
      find_extra(result, folder, *sums, k_own_files);
    }
    return result;
  }
  result.images = manifest.images;
  result.files = manifest.files.size();
  for (const FileRecord* file : differing_files(folder, manifest.files))
    check_file(result, folder, *file);
  std::map<std::string, Hash128> listed;
  for (const FileRecord& file : manifest.files)
    listed.emplace(file.path, file.hashes.xxh128);
  add_of_checksums();
  if (sums) check_checksums(result, folder, listed, *sums);
  find_extra(result, folder, listed, k_own_files);
  return result;
}

VerifyResult verify_whole_folder(const fs::path& folder, const WholeFolderKind& kind) {
  VerifyResult result;
  const std::set<std::string> own{kind.checksums};
  if (const auto sums = read_checksums(result, folder, kind.checksums)) {
    compare_with_checksums(result, folder, *sums, own, kind.checksums);
    find_extra(result, folder, *sums, own);
  }
  return result;
}

void verify_against_plan(VerifyResult& result, Dataset& dataset, const Plan& plan) {
  const auto records = keys_by_id(dataset.folder);
  std::set<std::string> wanted;
  for (const PlannedImage& image : plan.images) {
    const std::string& id = image.spec.id;
    wanted.insert(id);
    const auto record = records.find(id);
    if (record == records.end())
      result.findings.push_back(
          {Finding::Kind::missing, id, "the recipe names it, the manifest does not", ""});
    else if (image.error)
      result.findings.push_back({Finding::Kind::manifest, id, image.error->what(), ""});
    else if (record->second.render != image.keys.render || record->second.files != image.keys.files)
      result.findings.push_back({Finding::Kind::manifest, id,
                                 image.stale()
                                     ? fmt::format("it is of an older recipe or older assets: {}",
                                                   fmt::join(image.reasons, "; "))
                                     : "it is of an older recipe or older assets",
                                 ""});
  }
  for (const auto& [id, record] : records)
    if (!wanted.contains(id))
      result.findings.push_back(
          {Finding::Kind::extra, id, "the manifest names it, the recipe does not", ""});
  for (const auto& [path, placed] : dataset.database->placed_files(dataset.row.id)) {
    const fs::path file = dataset.folder / path;
    if (placed.kind == k_manifest_kind && stamp_of(file) && content_hash(file) != placed.object) {
      result.findings.push_back(
          {Finding::Kind::manifest, path, "it is not the one the last build wrote", ""});
      return;
    }
  }
  for (const std::string& what : plan.manifest.behind)
    result.findings.push_back({Finding::Kind::manifest, "manifest", "it is behind: " + what, ""});
}

void verify_by_tracing(VerifyResult& result, Dataset& dataset, const Plan& plan, Inputs& inputs,
                       Renderer& renderer, std::uint64_t count, std::uint64_t seed,
                       const std::function<void(const std::string& id)>& told,
                       const std::atomic<bool>& stop) {
  const auto records = records_by_id(dataset.folder);
  for (const PlannedImage* image : choose(plan, count, seed)) {
    const auto record = records.find(image->spec.id);
    if (record == records.end() || image->error) continue;  // reported by verify_against_plan
    told(image->spec.id);
    Rerender rerender(dataset.recipe, inputs, renderer, *image, stop);
    compare_rerendered(result, rerender, *image, record->second);
    ++result.rerendered;
  }
}

}  // namespace ds
