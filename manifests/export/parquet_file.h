// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/export_folder.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// Type of a column. Everything is optional, as readers' own types are.
enum class ParquetType {
  text,
  int64,
  float64,
  image,           ///< a group of bytes and path
  int64_list,      ///< of at least one number
  float64_list,    ///< likewise
  float64_matrix,  ///< a list of lists, none of them empty
};

/// An image's value in a row: a JSON text "path", and its bytes beside the row.
struct ParquetImage {
  std::string path, bytes;
};

/// Apache Parquet files (format 2.x, thrift compact): plain, uncompressed, one page a column chunk, so that
/// bytes depend on the rows alone. Pictures do not compress, and they are nearly all of it. Debian
/// has no library that writes it.
class ParquetFile {
 public:
  struct Column {
    std::string name;
    ParquetType type;
  };
  /// `info`: what the footer's key "huggingface" says.
  ParquetFile(ExportFolder& to, const std::string& path, std::vector<Column> columns,
              std::string info);
  ~ParquetFile();
  ParquetFile(const ParquetFile&) = delete;
  ParquetFile& operator=(const ParquetFile&) = delete;

  /// `row` has every column but images, or null; `images` in the order of their columns.
  void add(const nlohmann::json& row, const std::vector<ParquetImage>& images);
  void close();
  std::uint64_t bytes() const;

 private:
  struct Leaf;
  void write_group();

  ExportFolder::Stream file_;
  std::vector<Column> columns_;
  std::string info_;
  std::vector<Leaf> leaves_;
  std::string groups_;  ///< thrift of those written
  std::uint64_t rows_ = 0, rows_in_group_ = 0, bytes_in_group_ = 0;
  std::size_t group_count_ = 0;
};

}  // namespace ds
