// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"
#include "manifests/export/parquet_file.h"

#include <memory>
#include <string>
#include <vector>

namespace ds {

/// data/SPLIT-NNNNN.parquet, with the pictures in it.
class Parquet : public Exporter {
 public:
  Parquet(const ExportInput& input, ExportFolder& to);
  void add(const ExportImage& image) override;
  void finish() override;
  std::string card_lines() const override;
  const std::vector<ParquetFile::Column>& columns() const { return columns_; }

 private:
  bool is_exr(const std::string& kind) const;

  struct Split {
    std::unique_ptr<ParquetFile> file;
    int number = 0;
  };
  const ExportInput& input_;
  ExportFolder& to_;
  std::vector<std::string> kinds_;  ///< of files in it
  std::vector<ParquetFile::Column> columns_;
  std::string info_;
  std::map<std::string, std::uint64_t> bytes_;  ///< of each split's pictures
  std::map<std::string, Split> splits_;
};

}  // namespace ds
