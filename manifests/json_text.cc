// SPDX-License-Identifier: Apache-2.0
#include "manifests/json_text.h"

#include "tracer/base/error.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace ds {
namespace {

class Writer {
 public:
  explicit Writer(int indent) : indent_(indent) {}

  void write(const nlohmann::json& value) {
    if (value.is_object()) {
      write_object(value);
    } else if (value.is_array()) {
      write_array(value);
    } else if (value.is_number_float()) {
      write_float(value.get<double>());
    } else {
      write_plain(value);
    }
  }
  std::string take() { return std::move(text_); }

 private:
  void write_object(const nlohmann::json& value) {
    open('{');
    bool first = true;
    for (const auto& [key, member] : value.items()) {
      next(first);
      write_plain(key);
      text_ += indent_ > 0 ? ": " : ":";
      write(member);
    }
    close('}', value.empty());
  }

  void write_array(const nlohmann::json& value) {
    open('[');
    bool first = true;
    for (const auto& member : value) {
      next(first);
      write(member);
    }
    close(']', value.empty());
  }

  void write_float(double value) {
    if (!std::isfinite(value))
      fail(ErrorKind::asset, "a manifest's numbers must be finite, got {}", value);
    const std::size_t begin = text_.size();
    fmt::format_to(std::back_inserter(text_), "{}", value == 0 ? 0.0 : value);
    if (text_.find_first_of(".e", begin) == text_.npos) text_ += ".0";
  }

  /// Text, integers, booleans, null: one spelling each.
  void write_plain(const nlohmann::json& value) {
    try {
      text_ += value.dump();
    } catch (const nlohmann::json::exception&) {
      fail(ErrorKind::asset, "a manifest's texts must be UTF-8, got {:?}",
           value.get_ref<const std::string&>());
    }
  }

  void open(char bracket) {
    text_ += bracket;
    ++depth_;
  }
  void next(bool& first) {
    if (!first) text_ += ',';
    first = false;
    new_line();
  }
  void close(char bracket, bool empty) {
    --depth_;
    if (!empty) new_line();
    text_ += bracket;
  }
  void new_line() {
    if (indent_ == 0) return;
    text_ += '\n';
    text_.append(static_cast<std::size_t>(indent_) * depth_, ' ');
  }

  int indent_;
  std::size_t depth_ = 0;
  std::string text_;
};

}  // namespace

std::string canonical_json(const nlohmann::json& value, int indent) {
  Writer writer(indent);
  writer.write(value);
  std::string text = writer.take();
  if (indent > 0) text += '\n';
  return text;
}

std::string json_fault(const nlohmann::json::exception& error) {
  const std::string text = error.what();  // "[json.exception.KIND.NUMBER] ..."
  const std::size_t kind_end = text.find("] ");
  return text.starts_with("[json.exception.") && kind_end != text.npos ? text.substr(kind_end + 2)
                                                                       : text;
}

}  // namespace ds
