// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ds {

/// Thrift's compact protocol: a struct whose fields are written in ascending order of their numbers
/// (Apache Thrift, thrift-compact-protocol.md).
class ThriftStruct {
 public:
  enum Type { i32 = 5, i64 = 6, binary = 8, list = 9, structure = 12 };

  ThriftStruct& add(int field, Type type, std::int64_t number);
  ThriftStruct& add(int field, std::string_view text);
  ThriftStruct& add(int field, const ThriftStruct& value);
  /// `elements` one behind the other, as `number_bytes`, `text_bytes` or `bytes` give them.
  ThriftStruct& add_list(int field, Type type, std::size_t size, std::string_view elements);

  /// With the mark of its end.
  std::string bytes() const { return bytes_ + '\0'; }
  static std::string number_bytes(std::int64_t number);
  static std::string text_bytes(std::string_view text);

 private:
  void begin(int field, Type type);

  std::string bytes_;
  int last_ = 0;
};

}  // namespace ds
