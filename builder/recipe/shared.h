// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace ds {

/// A value that thousands of images have in common, held once for all of them. Reads as a
/// `const T&`; assigning gives this holder another value and leaves the others theirs.
template <typename T>
class Shared {
 public:
  Shared() : value_(nothing()) {}
  template <typename U>
  requires(std::is_convertible_v<U, T> && !std::is_same_v<std::remove_cvref_t<U>, Shared>)
      // It stands for the value; the constraint keeps it off copies, which clang-tidy does not see.
      // NOLINTNEXTLINE(google-explicit-constructor,bugprone-forwarding-reference-overload)
      Shared(U&& value)
      : value_(std::make_shared<const T>(std::forward<U>(value))) {}

  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  // NOLINTNEXTLINE(google-explicit-constructor): as above
  operator const T&() const { return *value_; }
  /// Whether both hold one object, which says at once that the values are equal.
  bool is_same(const Shared& other) const { return value_ == other.value_; }
  /// Tells this object from all others for as long as somebody holds it.
  const void* identity() const { return value_.get(); }

  friend bool operator==(const Shared& a, const Shared& b) { return a.is_same(b) || *a == *b; }
  template <typename U>
  requires(std::is_convertible_v<const U&, T> && !std::is_same_v<U, Shared>) friend bool operator==(
      const Shared& a, const U& b) {
    return *a == b;
  }
  friend bool operator<(const Shared& a, const Shared& b) { return !a.is_same(b) && *a < *b; }

 private:
  static const std::shared_ptr<const T>& nothing() {
    static const auto empty = std::make_shared<const T>();
    return empty;
  }

  std::shared_ptr<const T> value_;
};

}  // namespace ds
