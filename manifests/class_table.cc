// SPDX-License-Identifier: Apache-2.0
#include "manifests/class_table.h"

#include "tracer/base/error.h"
#include "tracer/base/text_lines.h"
#include "tracer/base/utf8.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace ds {
namespace {

using Row = std::vector<std::string>;

/// Takes rows off a text.
class CsvRows {
 public:
  CsvRows(std::string_view text, const std::string& file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {}

  /// The next row that is no empty line; nothing at the end.
  std::optional<Row> next() {
    while (at_ < text_.size()) {
      line_ = next_line_;
      Row row = take_row();
      if (row.size() > 1 || !row[0].empty()) return row;
    }
    return std::nullopt;
  }
  /// Where the row that was taken last begins.
  SourcePlace place() const { return {file_, line_, 0}; }

 private:
  bool ends_line() const { return text_[at_] == '\n' || text_[at_] == '\r'; }

  Row take_row() {
    Row row{take_field()};
    while (at_ < text_.size() && text_[at_] == ',') {
      ++at_;
      row.push_back(take_field());
    }
    if (at_ < text_.size()) take_line_end();
    return row;
  }

  void take_line_end() {
    if (text_.substr(at_).starts_with("\r\n")) ++at_;
    ++at_;
    ++next_line_;
  }

  std::string take_field() {
    std::string field;
    if (at_ < text_.size() && text_[at_] == '"') take_quoted(field);
    // Behind a quote nothing should stand; what does belongs to the field.
    while (at_ < text_.size() && text_[at_] != ',' && !ends_line())
      field += text_[at_++];
    return field;
  }

  void take_quoted(std::string& field) {
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        if (!text_.substr(at_ + 1).starts_with('"')) {
          ++at_;
          return;
        }
        ++at_;
      }
      if (text_[at_] == '\n') ++next_line_;
      field += text_[at_];
    }
    diagnostics_.add(place(), "a quote is not closed");
  }

  std::string_view text_;
  std::string file_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  int line_ = 1, next_line_ = 1;
};

constexpr std::array<std::string_view, 3> k_columns{"name", "class", "split"};
constexpr std::size_t k_name = 0, k_class = 1, k_split = 2;

/// Which column of the file each of k_columns is.
using Columns = std::array<std::optional<std::size_t>, k_columns.size()>;

Columns find_columns(const Row& header, const SourcePlace& place, Diagnostics& diagnostics) {
  Columns columns;
  for (std::size_t c = 0; c < header.size(); ++c) {
    const auto at = std::find(k_columns.begin(), k_columns.end(), header[c]);
    if (at == k_columns.end()) continue;
    std::optional<std::size_t>& column = columns[static_cast<std::size_t>(at - k_columns.begin())];
    if (column) diagnostics.add(place, "has two columns {}", header[c]);
    column = c;
  }
  if (!columns[k_name] || !columns[k_class])
    diagnostics.add(place, "must name the columns name and class, and may split, found \"{}\"",
                    fmt::join(header, ","));
  return columns;
}

}  // namespace

std::string trimmed_class(std::string_view path) {
  constexpr std::string_view k_blank = " \t";
  std::string trimmed;
  for (;;) {
    std::string_view part = path.substr(0, path.find('/'));
    const bool is_last = part.size() == path.size();
    if (!is_last) path.remove_prefix(part.size() + 1);
    part.remove_prefix(std::min(part.find_first_not_of(k_blank), part.size()));
    trimmed += part.substr(0, part.find_last_not_of(k_blank) + 1);
    if (is_last) return trimmed;
    trimmed += '/';
  }
}

std::vector<LabelledModel> parse_class_table(std::string_view text, const std::string& name) {
  Diagnostics diagnostics(ErrorKind::asset);
  check_utf8(text, name, diagnostics);
  diagnostics.throw_if_any();
  CsvRows rows(without_bom(text), name, diagnostics);
  const std::optional<Row> header = rows.next();
  if (!header) diagnostics.add({name}, "must name the columns name and class, found an empty file");
  diagnostics.throw_if_any();
  const Columns columns = find_columns(*header, rows.place(), diagnostics);
  diagnostics.throw_if_any();

  std::vector<LabelledModel> models;
  std::map<std::string, int> lines;
  while (const std::optional<Row> row = rows.next()) {
    const SourcePlace place = rows.place();
    if (row->size() != header->size()) {
      diagnostics.add(place, "must have {} fields as the first line, found {}", header->size(),
                      row->size());
      continue;
    }
    LabelledModel model{
        (*row)[*columns[k_name]], {trimmed_class((*row)[*columns[k_class]]), ""}, place};
    if (columns[k_split]) model.label.split = (*row)[*columns[k_split]];
    if (model.model.empty()) diagnostics.add(place, "the name is empty");
    if (!is_class_path(model.label.class_path))
      diagnostics.add(place,
                      "a class must be names with / between, none of 0 . .., without control "
                      "characters, got {:?}",
                      model.label.class_path);
    if (const std::string called = model.label.split; !called.empty()) {
      model.label.split = split_named(called);
      if (model.label.split.empty())
        diagnostics.add(place, "split must be train, val, test or empty, got \"{}\"", called);
    }
    const auto [first, is_new] = lines.try_emplace(model.model, place.line);
    if (!is_new)
      diagnostics.add(place, "model {} stands twice, first in line {}", model.model, first->second);
    models.push_back(std::move(model));
  }
  diagnostics.throw_if_any();
  return models;
}

}  // namespace ds
