// SPDX-License-Identifier: Apache-2.0
// parquet-format 2.x: "PAR1", row groups of column chunks of one data page each, the footer in thrift, its
// length, "PAR1". Levels (Dremel's) say of each value how far its path is there (definition) and at which
// list it goes on (repetition).
#include "manifests/export/parquet_file.h"

#include "manifests/export/thrift.h"
#include "tracer/base/error.h"

#include <bit>
#include <utility>

namespace ds {
namespace {

using json = nlohmann::json;
using Thrift = ThriftStruct;

enum Physical { k_int64 = 2, k_double = 5, k_byte_array = 6 };
enum Repetition { k_optional = 1, k_repeated = 2 };
constexpr int k_plain = 0, k_rle = 3;        // encodings
constexpr int k_utf8 = 0, k_list = 3;        // converted types
constexpr std::uint64_t k_group_rows = 100;  // what the hub's viewer takes
constexpr std::uint64_t k_group_bytes = 100'000'000;

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i)
    text.push_back(static_cast<char>(value >> (8 * i) & 255U));
  return text;
}

/// RLE runs of a level below 256, with their length before them.
std::string levels_text(const std::string& levels) {
  std::string runs;
  for (std::size_t at = 0; at < levels.size();) {
    std::size_t end = levels.find_first_not_of(levels[at], at);
    if (end == levels.npos) end = levels.size();
    std::uint64_t header = (end - at) << 1U;
    for (; header >= 128; header >>= 7U)
      runs.push_back(static_cast<char>((header & 127U) | 128U));
    runs.push_back(static_cast<char>(header));
    runs.push_back(levels[at]);
    at = end;
  }
  return little(runs.size(), 4) + runs;
}

std::string schema_element(const std::string& name, Repetition repetition, int children,
                           std::optional<Physical> type, std::optional<int> converted) {
  Thrift element;
  if (type) element.add(1, Thrift::i32, *type);
  element.add(3, Thrift::i32, repetition).add(4, name);
  if (children > 0) element.add(5, Thrift::i32, children);
  if (converted) element.add(6, Thrift::i32, *converted);
  return element.bytes();
}

}  // namespace

/// One column of values and their levels, of the rows that wait to be written.
struct ParquetFile::Leaf {
  std::vector<std::string> path;
  Physical type;
  int most_definition, most_repetition;
  std::string values{}, definitions{}, repetitions{};
  std::uint64_t count = 0;

  void level(int definition, int repetition) {
    definitions.push_back(static_cast<char>(definition));
    repetitions.push_back(static_cast<char>(repetition));
    ++count;
  }
  void add(const json& value, int repetition = 0) {
    if (value.is_null()) {
      level(0, repetition);
      return;
    }
    level(most_definition, repetition);
    if (type == k_int64)
      values += little(static_cast<std::uint64_t>(value.get<std::int64_t>()), 8);
    else if (type == k_double)
      values += little(std::bit_cast<std::uint64_t>(value.get<double>()), 8);
    else
      add_bytes(value.get_ref<const std::string&>());
  }
  void add_bytes(std::string_view bytes) { (values += little(bytes.size(), 4)) += bytes; }
};

ParquetFile::ParquetFile(ExportFolder& to, const std::string& path, std::vector<Column> columns,
                         std::string info)
    : file_(to, path), columns_(std::move(columns)), info_(std::move(info)) {
  file_.write("PAR1");
  for (const auto& [name, type] : columns_) {
    switch (type) {
      case ParquetType::text:
        leaves_.push_back({{name}, k_byte_array, 1, 0});
        break;
      case ParquetType::int64:
        leaves_.push_back({{name}, k_int64, 1, 0});
        break;
      case ParquetType::float64:
        leaves_.push_back({{name}, k_double, 1, 0});
        break;
      case ParquetType::image:
        leaves_.push_back({{name, "bytes"}, k_byte_array, 2, 0});
        leaves_.push_back({{name, "path"}, k_byte_array, 2, 0});
        break;
      case ParquetType::int64_list:
        leaves_.push_back({{name, "list", "element"}, k_int64, 3, 1});
        break;
      case ParquetType::float64_list:
        leaves_.push_back({{name, "list", "element"}, k_double, 3, 1});
        break;
      case ParquetType::float64_matrix:
        leaves_.push_back({{name, "list", "element", "list", "element"}, k_double, 5, 2});
        break;
    }
  }
}

ParquetFile::~ParquetFile() = default;

std::uint64_t ParquetFile::bytes() const {
  return file_.bytes() + bytes_in_group_;
}

void ParquetFile::add(const json& row, const std::vector<ParquetImage>& images) {
  auto leaf = leaves_.begin();
  auto image = images.begin();
  for (const auto& [name, type] : columns_) {
    Leaf& column = *leaf++;
    if (type == ParquetType::image) {
      column.level(2, 0);
      column.add_bytes(image->bytes);
      Leaf& path = *leaf++;
      path.level(2, 0);
      path.add_bytes(image->path);
      ++image;
      continue;
    }
    const json& value = row.at(name);
    if (value.is_null() || !value.is_array()) {
      column.add(value);
      continue;
    }
    bool first_row = true;
    for (const json& element : value) {
      bool first = true;
      if (type == ParquetType::float64_matrix)
        for (const json& number : element)
          column.add(number,
                     std::exchange(first, false) ? (std::exchange(first_row, false) ? 0 : 1) : 2);
      else
        column.add(element, std::exchange(first_row, false) ? 0 : 1);
    }
  }
  bytes_in_group_ = 0;
  for (const Leaf& one : leaves_)
    bytes_in_group_ += one.values.size();
  if (++rows_in_group_ == k_group_rows || bytes_in_group_ >= k_group_bytes) write_group();
}

void ParquetFile::write_group() {
  if (rows_in_group_ == 0) return;
  std::string chunks;
  std::uint64_t group_bytes = 0;
  for (Leaf& leaf : leaves_) {
    std::string page;
    if (leaf.most_repetition > 0) page += levels_text(leaf.repetitions);
    page += levels_text(leaf.definitions);
    page += leaf.values;
    Thrift data;
    data.add(1, Thrift::i32, static_cast<std::int64_t>(leaf.count))
        .add(2, Thrift::i32, k_plain)
        .add(3, Thrift::i32, k_rle)
        .add(4, Thrift::i32, k_rle);
    const auto size = static_cast<std::int64_t>(page.size());
    const std::string head = Thrift()
                                 .add(1, Thrift::i32, 0)
                                 .add(2, Thrift::i32, size)
                                 .add(3, Thrift::i32, size)
                                 .add(5, data)
                                 .bytes();
    const auto at = static_cast<std::int64_t>(file_.bytes());
    const auto whole = static_cast<std::int64_t>(head.size()) + size;
    std::string path;
    for (const std::string& part : leaf.path)
      path += Thrift::text_bytes(part);
    Thrift column;
    column.add(1, Thrift::i32, leaf.type)
        .add_list(2, Thrift::i32, 2, Thrift::number_bytes(k_plain) + Thrift::number_bytes(k_rle))
        .add_list(3, Thrift::binary, leaf.path.size(), path)
        .add(4, Thrift::i32, 0)
        .add(5, Thrift::i64, static_cast<std::int64_t>(leaf.count))
        .add(6, Thrift::i64, whole)
        .add(7, Thrift::i64, whole)
        .add(9, Thrift::i64, at);
    chunks += Thrift().add(2, Thrift::i64, at).add(3, column).bytes();
    file_.write(head);
    file_.write(page);
    group_bytes += static_cast<std::uint64_t>(whole);
    leaf.values.clear();
    leaf.definitions.clear();
    leaf.repetitions.clear();
    leaf.count = 0;
  }
  groups_ += Thrift()
                 .add_list(1, Thrift::structure, leaves_.size(), chunks)
                 .add(2, Thrift::i64, static_cast<std::int64_t>(group_bytes))
                 .add(3, Thrift::i64, static_cast<std::int64_t>(rows_in_group_))
                 .bytes();
  ++group_count_;
  rows_ += std::exchange(rows_in_group_, 0);
  bytes_in_group_ = 0;
}

void ParquetFile::close() {
  write_group();
  std::string schema = Thrift()
                           .add(4, "schema")
                           .add(5, Thrift::i32, static_cast<std::int64_t>(columns_.size()))
                           .bytes();
  std::size_t elements = 1;
  const auto add = [&](const std::string& name, Repetition repetition, int children,
                       std::optional<Physical> type, std::optional<int> converted) {
    schema += schema_element(name, repetition, children, type, converted);
    ++elements;
  };
  for (const auto& [name, type] : columns_) {
    switch (type) {
      case ParquetType::text:
        add(name, k_optional, 0, k_byte_array, k_utf8);
        break;
      case ParquetType::int64:
        add(name, k_optional, 0, k_int64, {});
        break;
      case ParquetType::float64:
        add(name, k_optional, 0, k_double, {});
        break;
      case ParquetType::image:
        add(name, k_optional, 2, {}, {});
        add("bytes", k_optional, 0, k_byte_array, {});
        add("path", k_optional, 0, k_byte_array, k_utf8);
        break;
      case ParquetType::int64_list:
      case ParquetType::float64_list:
        add(name, k_optional, 1, {}, k_list);
        add("list", k_repeated, 1, {}, {});
        add("element", k_optional, 0, type == ParquetType::int64_list ? k_int64 : k_double, {});
        break;
      case ParquetType::float64_matrix:
        add(name, k_optional, 1, {}, k_list);
        add("list", k_repeated, 1, {}, {});
        add("element", k_optional, 1, {}, k_list);
        add("list", k_repeated, 1, {}, {});
        add("element", k_optional, 0, k_double, {});
        break;
    }
  }
  const std::string footer =
      Thrift()
          .add(1, Thrift::i32, 1)
          .add_list(2, Thrift::structure, elements, schema)
          .add(3, Thrift::i64, static_cast<std::int64_t>(rows_))
          .add_list(4, Thrift::structure, group_count_, groups_)
          .add_list(5, Thrift::structure, 1, Thrift().add(1, "huggingface").add(2, info_).bytes())
          .add(6, "dsbuild")
          .bytes();
  file_.write(footer);
  file_.write(little(footer.size(), 4) + "PAR1");
  file_.close();
}

}  // namespace ds
