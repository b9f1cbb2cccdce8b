// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/thrift.h"

namespace ds {
namespace {

std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 128; value >>= 7U)
    bytes.push_back(static_cast<char>((value & 127U) | 128U));
  bytes.push_back(static_cast<char>(value));
  return bytes;
}

}  // namespace

std::string ThriftStruct::number_bytes(std::int64_t number) {
  const auto bits = static_cast<std::uint64_t>(number);
  return varint(number < 0 ? ~(bits << 1U) : bits << 1U);  // zigzag
}

std::string ThriftStruct::text_bytes(std::string_view text) {
  return varint(text.size()) + std::string(text);
}

void ThriftStruct::begin(int field, Type type) {
  bytes_.push_back(static_cast<char>((field - last_) << 4 | type));
  last_ = field;
}

ThriftStruct& ThriftStruct::add(int field, Type type, std::int64_t number) {
  begin(field, type);
  bytes_ += number_bytes(number);
  return *this;
}

ThriftStruct& ThriftStruct::add(int field, std::string_view text) {
  begin(field, binary);
  bytes_ += text_bytes(text);
  return *this;
}

ThriftStruct& ThriftStruct::add(int field, const ThriftStruct& value) {
  begin(field, structure);
  bytes_ += value.bytes();
  return *this;
}

ThriftStruct& ThriftStruct::add_list(int field, Type type, std::size_t size,
                                     std::string_view elements) {
  begin(field, list);
  if (size < 15)
    bytes_.push_back(static_cast<char>(size << 4U | static_cast<unsigned>(type)));
  else
    bytes_ += static_cast<char>(0xf0 | type) + varint(size);
  bytes_ += elements;
  return *this;
}

}  // namespace ds
