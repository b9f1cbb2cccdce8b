// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/recipe/even_number.h"
#include "builder/recipe/value.h"
#include "tracer/base/number_range.h"

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// What a recipe's key that may be drawn holds.
enum class DrawnKind {
  number,
  integer,
  point,     ///< three numbers
  colour,    ///< three numbers, linear Rec.709
  rotation,  ///< a unit quaternion: w, x, y, z
};
/// How many numbers one is.
std::size_t width_of(DrawnKind kind);

/// "number", "point": for messages and references.
std::string_view name_of(DrawnKind kind);

/// Its first width_of() count.
using DrawnValue = std::array<double, 4>;

/// For what a value is drawn anew.
enum class DrawnPer { view, model, dataset };

struct DistributionWord;

/// A distribution as a recipe has it, { uniform = [35, 60] }, read and checked; or a constant.
struct Distribution {
  const DistributionWord* word = nullptr;  ///< none: the constant `numbers`
  std::vector<double> numbers;             ///< the word's, one behind the other
  DrawnKind kind = DrawnKind::number;
  DrawnPer per = DrawnPer::view;
  std::array<double, 2> within{-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
  std::array<double, 2> elevation_deg{-90, 90}, azimuth_deg{0, 360};
  std::array<double, 3> at{};
  std::array<double, 2> shares{};        ///< of normal: below the bounds
  std::vector<double> weights;           ///< of the candidates; none: alike
  std::vector<Distribution> candidates;  ///< of choice and cycle
  std::vector<std::string> names;        ///< each candidate as TOML
};

/// What of an image's even numbers a value is made of: one key's.
struct EvenNumbers {
  const DrawnFor& of;
  std::string_view identity, key;
  int first = 0;  ///< of a candidate's own numbers

  double operator()(int i) const {
    return of.number(of.seed, identity, key, first + i, of.attempt);
  }
};

/// What the first word of a distribution wants behind its "=".
enum class WordShape {
  range,       ///< [least, most]
  parameters,  ///< [mean, deviation]
  candidates,  ///< a list of values
  radius,      ///< a number
  radii,       ///< a number or [least, most]
  box,         ///< [[x, y, z], [x, y, z]]
  hsv,         ///< [[h, h], [s, s], [v, v]]
  turn,        ///< "up" or "any"
};

/// "two numbers, the lesser first".
std::string_view shape_text(WordShape shape);

/// One word of the grammar. A new one is a row of distribution_words().
struct DistributionWord {
  std::string_view name;
  std::span<const DrawnKind> kinds;
  WordShape shape;
  /// Words that may stand beside it; one that must has a "!" behind it.
  std::span<const std::string_view> beside;
  std::string_view help;
  /// What is amiss with numbers of the right shape; "" where nothing is. May be null.
  std::string (*check)(Distribution&);
  DrawnValue (*draw)(const Distribution&, const EvenNumbers&);
  bool by_view = false;  ///< goes on from view to view of a model, in whose name it is drawn
};

/// In the order of the reference.
std::span<const DistributionWord> distribution_words();
const DistributionWord* find_word(std::string_view name);
bool may_draw(const DistributionWord& word, DrawnKind kind);

/// Four numbers that are not all 0, of length 1.
std::vector<double> unit_quaternion(std::vector<double> numbers);

using Complaint = std::function<void(const RecipeValue& at, const std::string& message)>;

/// Whether a value is written as a distribution, well or badly.
inline bool is_distribution(const RecipeValue& value) {
  return value.table() != nullptr;
}

/// Nothing, and complaints, where it is none. `range`: of each number that it may give.
std::optional<Distribution> read_distribution(const RecipeValue& table, DrawnKind kind,
                                              const NumberRange& range, const Complaint& complain);

/// The value of a key for an image. The same bits on every machine.
DrawnValue draw(const Distribution& distribution, std::string_view key, const DrawnFor& of);

}  // namespace ds
