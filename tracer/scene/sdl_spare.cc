// SPDX-License-Identifier: Apache-2.0
// Things of a file that nothing uses, and those that a slip in a name made.
#include "tracer/base/log.h"
#include "tracer/base/nearest.h"
#include "tracer/scene/sdl_reader.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace ds {
namespace {

std::string thing(SdlKind kind, const std::string& name) {
  return fmt::format("{}.{}", section_of(kind), name);
}

/// "wall1" and "wall2" are two things, whatever else.
bool differ_in_digits_only(std::string a, std::string b) {
  const auto drop_digits = [](std::string& text) {
    std::erase_if(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  drop_digits(a);
  drop_digits(b);
  return a == b;
}

/// The things of one kind in the order in which they first stand in the file.
class Things {
 public:
  Things(SdlReader& reader, SdlKind kind)
      : reader_(reader), kind_(kind), names_(reader.properties.names_below(section_of(kind))) {}

  const std::vector<std::string>& names() const { return names_; }
  bool has_type(const std::string& name) const {
    return reader_.properties.find(thing(kind_, name) + ".type") != nullptr;
  }
  /// Lights and objects are there for themselves, and the last material of a material file.
  bool is_spare(const std::string& name) const {
    if (kind_ == SdlKind::light || kind_ == SdlKind::object) return false;
    if (kind_ == SdlKind::material && !reader_.environment && name == names_.back()) return false;
    return !reader_.referred.contains(thing(kind_, name));
  }
  /// The one with the most similar name; "" where none looks like it.
  std::string like(const std::string& name) const {
    std::vector<std::string> others;
    std::copy_if(names_.begin(), names_.end(), std::back_inserter(others), [&](const auto& other) {
      return other != name && !differ_in_digits_only(other, name);
    });
    return std::string(nearest(name, others));
  }
  SourcePlace place(const std::string& name) const {
    return reader_.properties.first_below(thing(kind_, name))->place;
  }

 private:
  SdlReader& reader_;
  SdlKind kind_;
  std::vector<std::string> names_;
};

}  // namespace

void report_slips(SdlReader& reader, std::span<const SdlKind> kinds) {
  for (const SdlKind kind : kinds) {
    if (kind == SdlKind::object) continue;  // one without a mesh is an error anyway
    const Things things(reader, kind);
    for (const std::string& name : things.names()) {
      if (things.has_type(name) || reader.broken.contains(thing(kind, name))) continue;
      const std::string meant = things.like(name);
      if (meant.empty() || !things.has_type(meant)) continue;
      // Lights take a default type for themselves; of two others both of which are used, both are meant.
      if (kind != SdlKind::light && !things.is_spare(name) && !things.is_spare(meant)) continue;
      reader.diagnostics.add(things.place(name),
                             "{} has no type and is another {} than {}, did you mean {}?",
                             thing(kind, name), word_for(kind), meant, thing(kind, meant));
    }
  }
}

bool warn_of_spare(SdlReader& reader, std::span<const SdlKind> kinds) {
  bool any = false;
  for (const SdlKind kind : kinds) {
    const Things things(reader, kind);
    for (const std::string& name : things.names()) {
      if (!things.is_spare(name)) continue;
      any = true;
      const std::string why =
          kind == SdlKind::material && !reader.environment
              ? fmt::format(": a material file is for its last material, {}", things.names().back())
              : std::string();
      warn(fmt::format("{}: {} is used by nothing{}", to_string(things.place(name)),
                       thing(kind, name), why));
    }
  }
  return any;
}

}  // namespace ds
