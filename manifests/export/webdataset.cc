// SPDX-License-Identifier: Apache-2.0
// WebDataset: NAME-SPLIT-%06d.tar, USTAR files of up to 1 GB, in which the members KEY.cls, KEY.json,
// KEY.mask.png and KEY.png of a sample follow each other. A sample's key ends at its first dot.
#include "manifests/export/exporter.h"
#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <algorithm>

namespace ds {
namespace {

constexpr std::uint64_t k_shard_bytes = 1'000'000'000;
constexpr std::size_t k_block = 512;

void put(std::string& header, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

/// Of a plain file, with nothing of this machine: owner 0, time 0 (POSIX.1-1988, "ustar").
std::string tar_header(const std::string& name, std::size_t size) {
  if (name.size() > 100)
    fail(ErrorKind::asset, "{}: its name must be of at most 100 bytes in a tar file, got {}", name,
         name.size());
  std::string header(k_block, '\0');
  put(header, 0, name);
  put(header, 100, "0000644");
  put(header, 108, "0000000");
  put(header, 116, "0000000");
  put(header, 124, fmt::format("{:011o}", size));
  put(header, 136, "00000000000");
  put(header, 148, "        ");
  put(header, 156, "0");
  put(header, 257,
      std::string_view("ustar\0"
                       "00",
                       8));
  unsigned sum = 0;
  for (const char c : header)
    sum += static_cast<unsigned char>(c);
  put(header, 148, std::string_view(fmt::format("{:06o}", sum) + '\0' + ' '));
  return header;
}

/// A split's files, one after the other.
class Shards {
 public:
  Shards(ExportFolder& to, std::string stem) : to_(to), stem_(std::move(stem)) {}

  /// The members of one sample, which stay together.
  void add(const std::vector<std::pair<std::string, std::string>>& members) {
    std::string bytes;
    for (const auto& [name, content] : members) {
      bytes += tar_header(name, content.size());
      bytes += content;
      bytes.resize((bytes.size() + k_block - 1) / k_block * k_block);
    }
    if (tar_ && tar_->bytes() + bytes.size() > k_shard_bytes) close();
    if (!tar_)
      tar_ = std::make_unique<ExportFolder::Stream>(to_,
                                                    fmt::format("{}-{:06}.tar", stem_, number_++));
    tar_->write(bytes);
  }
  void close() {
    if (!tar_) return;
    constexpr std::size_t k_record = 20 * k_block;  // what tar itself writes
    const std::size_t end = 2 * k_block;
    tar_->write(std::string(
        (tar_->bytes() + end + k_record - 1) / k_record * k_record - tar_->bytes(), '\0'));
    tar_->close();
    tar_.reset();
  }

 private:
  ExportFolder& to_;
  std::string stem_;
  std::unique_ptr<ExportFolder::Stream> tar_;
  int number_ = 0;
};

class WebDataset : public Exporter {
 public:
  WebDataset(const ExportInput& input, ExportFolder& to) : input_(input), to_(to) {}

  void add(const ExportImage& image) override {
    std::vector<std::pair<std::string, std::string>> members;
    for (const std::string& kind : input_.kinds) {
      const FileRecord& file = file_of(image, kind);
      members.emplace_back(image.key + (kind == "image" ? "" : "." + kind) + ending_of(file),
                           read_checked(input_.folder, file));
    }
    members.emplace_back(image.key + ".cls", std::to_string(image.label));
    members.emplace_back(image.key + ".json", canonical_json(sample_fields(input_, image)));
    std::sort(members.begin(), members.end());
    const auto [at, is_new] = shards_.try_emplace(
        image.split, to_, fmt::format("{}-{}", input_.dataset.name, image.split));
    at->second.add(members);
  }
  /// Shards by their splits' names are what the library looks for by itself.
  std::string card_lines() const override { return ""; }
  void finish() override {
    for (auto& [split, shards] : shards_)
      shards.close();
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  std::map<std::string, Shards> shards_;
};

}  // namespace

ExporterType webdataset_exporter() {
  return {"webdataset", "WebDataset: NAME-SPLIT-000000.tar and so on",
          {"image"},    {},
          true,         make_exporter<WebDataset>};
}

}  // namespace ds
