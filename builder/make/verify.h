// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/renderer.h"
#include "builder/plan/plan.h"
#include "manifests/manifest.h"
#include "manifests/whole_folder.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ds {

/// One thing that is not as the manifest says.
struct Finding {
  enum class Kind {
    missing,   ///< a listed file, or an image of the recipe, is not there
    extra,     ///< a file nothing lists
    changed,   ///< other bytes and other pixels
    encoding,  ///< other bytes, but the same pixels: another encoder, or metadata was added
    manifest,  ///< the manifest contradicts itself or what was built
    rerender,  ///< tracing again gives something else
  };
  Kind kind;
  std::string path;    ///< relative to the dataset's folder, or an image's id
  std::string what;    ///< the same words for all findings of one cause
  std::string detail;  ///< what is this one's own: hashes and sizes; may be empty
};
/// What, and its detail.
std::string to_text(const Finding& finding);
const char* to_string(Finding::Kind kind);

struct VerifyResult {
  std::uint64_t images = 0, files = 0, rerendered = 0;
  bool has_manifest = true;  ///< that can be read; else the files are compared with their checksums
  std::vector<Finding> findings;
};

/// Reads every file under the folder and compares it with the manifest. Needs neither recipe nor
/// database. Throws Error(asset) where there is no manifest. Of a damaged one that is a finding, and
/// the files are compared with the checksum file.
VerifyResult verify_files(const std::filesystem::path& folder);

/// An export or a gallery against its own checksums. `images` stays 0.
VerifyResult verify_whole_folder(const std::filesystem::path& folder, const WholeFolderKind& kind);

/// Adds what only the recipe and the database can tell: images the manifest lacks or has too many
/// of, keys of an older recipe, a manifest that is not the one written.
void verify_against_plan(VerifyResult& result, Dataset& dataset, const Plan& plan);

/// Traces `count` images of the plan again, chosen by hash of `seed` and id, without looking into
/// the store, and compares every file's bytes with what the manifest says. Calls `told` before
/// each.
void verify_by_tracing(VerifyResult& result, Dataset& dataset, const Plan& plan, Inputs& inputs,
                       Renderer& renderer, std::uint64_t count, std::uint64_t seed,
                       const std::function<void(const std::string& id)>& told,
                       const std::atomic<bool>& stop);

}  // namespace ds
