// SPDX-License-Identifier: Apache-2.0
// One table of all images (RFC 4180, UTF-8, line ends of one character), with its files beside it.
#include "manifests/export/exporter.h"
#include "manifests/export/sample_fields.h"
#include "manifests/json_text.h"

#include <fmt/format.h>

namespace ds {
namespace {

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// A text as it is, nothing of null, anything else as JSON.
std::string cell(const nlohmann::json& value) {
  if (value.is_null()) return "";
  return cell(value.is_string() ? value.get<std::string>() : canonical_json(value));
}

class Csv : public Exporter {
 public:
  Csv(const ExportInput& input, ExportFolder& to)
      : input_(input), to_(to), table_(to, "images.csv") {}

  void add(const ExportImage& image) override {
    nlohmann::json fields = sample_fields(input_, image);
    for (const std::string& kind : input_.kinds) {
      const std::string path = place_of_kind(image, kind);
      to_.place(file_of(image, kind), path);
      fields[kind + "_file"] = path;
    }
    std::vector<std::string> head, row;
    for (const auto& [name, value] : fields.items()) {
      head.push_back(cell(name));
      row.push_back(cell(value));
    }
    if (!std::exchange(begun_, true)) table_.write(fmt::format("{}\n", fmt::join(head, ",")));
    table_.write(fmt::format("{}\n", fmt::join(row, ",")));
  }
  void finish() override { table_.close(); }

  /// All in one split: which row is of which of the dataset's, the table's column says.
  std::string card_lines() const override {
    return "configs:\n- config_name: default\n  data_files:\n  - split: images\n    path: "
           "images.csv\n";
  }

 private:
  const ExportInput& input_;
  ExportFolder& to_;
  ExportFolder::Stream table_;
  bool begun_ = false;
};

}  // namespace

ExporterType csv_exporter() {
  return {
      "csv", "one table, images.csv, and the files it names", {}, {}, false, make_exporter<Csv>};
}

}  // namespace ds
