// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/scene/mesh_text.h"
#include "tracer/scene/ply_header.h"

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace ds {

/// The values of a PLY body one after another. Both sources have the same functions, so that the
/// reader is one template:
///   begin/end     around the values of one element; `what` and `i` of `count` name it in messages
///   number        a value as a double
///   index         a value as a vertex index, see LineCursor::index
///   list_size     the count of a list of items of type `item`; a binary one fits what is left
///   skip          passes `count` values
///   finish        ends the body: how many bytes follow that are no part of it
///   fail_here     throws with the place reached
/// All throw Error(asset) at a value that is not there or is of another kind.

/// Text: the values of one element stand on one line; blank lines are skipped.
class PlyTextSource {
 public:
  PlyTextSource(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : cursor_(name, bytes.substr(header.body_offset), header.body_line, '\0') {}

  void begin(const PlyElement& element, std::uint64_t i) {
    element_ = &element;
    if (!cursor_.next_line())
      cursor_.fail_here("cut off: the header promises {} of element {}, found {}", element.count,
                        printable(element.name), i);
  }
  void end() {
    if (!cursor_.line_done())
      cursor_.fail_here("more values than element {} has properties", printable(element_->name));
  }
  double number(PlyType) {
    need_value();
    return cursor_.number();
  }
  std::uint32_t index(PlyType) {
    need_value();
    return cursor_.index();
  }
  std::uint64_t list_size(PlyType, PlyType) {
    need_value();
    const std::int64_t size = cursor_.integer();
    if (size < 0) cursor_.fail_here("a list of {} values", size);
    return static_cast<std::uint64_t>(size);
  }
  void skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      need_value();
      cursor_.number();
    }
  }
  std::size_t bytes_left() const { return cursor_.bytes_left(); }
  std::size_t finish() {
    if (!cursor_.next_line()) return 0;
    cursor_.line_done();  // passes blanks
    // Further values contradict the header; anything else is no part of the mesh.
    if (parse_number(cursor_.rest()).size > 0)
      cursor_.fail_here("text behind the last element the header promises");
    return cursor_.bytes_left();
  }
  [[noreturn]] void fail_here(const std::string& message) const {
    cursor_.fail_here("{}", message);
  }

 private:
  void need_value() {
    if (cursor_.line_done())
      cursor_.fail_here("fewer values than element {} has", printable(element_->name));
  }

  LineCursor cursor_;
  const PlyElement* element_ = nullptr;
};

template <std::endian order>
class PlyBinarySource {
 public:
  PlyBinarySource(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : bytes_(bytes), at_(header.body_offset), name_(name) {}

  void begin(const PlyElement& element, std::uint64_t i) {
    element_ = &element;
    i_ = i;
  }
  void end() {}
  double number(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return load<std::int8_t>();
      case PlyType::uint8:
        return load<std::uint8_t>();
      case PlyType::int16:
        return load<std::int16_t>();
      case PlyType::uint16:
        return load<std::uint16_t>();
      case PlyType::int32:
        return load<std::int32_t>();
      case PlyType::uint32:
        return load<std::uint32_t>();
      case PlyType::float32:
        return load<float>();
      case PlyType::float64:
        return load<double>();
    }
    DS_ASSERT(false);
    return 0;
  }
  std::uint32_t index(PlyType type) { return LineCursor::to_index(number(type)); }
  std::uint64_t list_size(PlyType count, PlyType item) {
    const std::size_t place = at_;
    const double size = number(count);
    if (size < 0) fail(ErrorKind::asset, "{}: byte {}: a list of {} values", name_, place, size);
    need(static_cast<std::uint64_t>(size), size_bytes(item));
    return static_cast<std::uint64_t>(size);
  }
  void skip(PlyType type, std::uint64_t count) {
    need(count, size_bytes(type));
    at_ += static_cast<std::size_t>(count) * size_bytes(type);
  }
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  std::size_t finish() {
    // Some writers end the file with a line break.
    return bytes_.substr(at_).find_first_not_of("\r\n") == bytes_.npos ? 0 : bytes_left();
  }
  [[noreturn]] void fail_here(const std::string& message) const {
    fail(ErrorKind::asset, "{}: byte {}: {}", name_, at_, message);
  }

 private:
  /// `count` is at most 2^32, so that the product cannot overflow.
  void need(std::uint64_t count, std::size_t size) const {
    if (count * size > bytes_left())
      fail(ErrorKind::asset, "{}: byte {}: cut off in element {} number {} of {}", name_,
           bytes_.size(), printable(element_->name), i_ + 1, element_->count);
  }
  template <typename T>
  double load() {
    need(1, sizeof(T));
    char raw[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i)
      raw[i] = bytes_[at_ + (order == std::endian::native ? i : sizeof(T) - 1 - i)];
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return static_cast<double>(value);
  }

  std::string_view bytes_;
  std::size_t at_;  ///< from the start of the file
  std::string name_;
  const PlyElement* element_ = nullptr;
  std::uint64_t i_ = 0;
};

}  // namespace ds
