// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/distribution.h"

#include "tracer/base/nearest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ds {
namespace {

using Numbers = std::vector<double>;

/// The numbers of a list of so many; nothing where it is none.
std::optional<Numbers> numbers_of(const RecipeValue& value, std::size_t least, std::size_t most) {
  const RecipeValue::Array* list = value.array();
  if (list == nullptr || list->size() < least || list->size() > most) return std::nullopt;
  Numbers numbers;
  for (const RecipeValue& element : *list) {
    if (!element.is_number() || !std::isfinite(element.number())) return std::nullopt;
    numbers.push_back(element.number());
  }
  return numbers;
}

std::optional<Numbers> range_of(const RecipeValue& value) {
  std::optional<Numbers> range = numbers_of(value, 2, 2);
  return range && (*range)[0] <= (*range)[1] ? range : std::nullopt;
}

std::optional<Numbers> rows_of(const RecipeValue& value, std::size_t rows, std::size_t columns) {
  const RecipeValue::Array* list = value.array();
  if (list == nullptr || list->size() != rows) return std::nullopt;
  Numbers all;
  for (const RecipeValue& row : *list) {
    const std::optional<Numbers> numbers = numbers_of(row, columns, columns);
    if (!numbers) return std::nullopt;
    all.insert(all.end(), numbers->begin(), numbers->end());
  }
  return all;
}

std::optional<Numbers> radii_of(const RecipeValue& value) {
  if (!value.is_number()) {
    std::optional<Numbers> radii = range_of(value);
    return radii && (*radii)[0] >= 0 ? radii : std::nullopt;
  }
  const double radius = value.number();
  if (!(radius >= 0) || !std::isfinite(radius)) return std::nullopt;
  return Numbers{0, radius};
}

constexpr std::string_view k_range_text = "two numbers, the lesser first";

}  // namespace

std::string_view shape_text(WordShape shape) {
  switch (shape) {
    case WordShape::range:
      return k_range_text;
    case WordShape::parameters:
      return "two numbers, mean and deviation";
    case WordShape::candidates:
      return "a list of values";
    case WordShape::radius:
      return "a radius >= 0";
    case WordShape::radii:
      return "a radius >= 0 or two, the lesser first";
    case WordShape::box:
      return "two corners of three numbers each";
    case WordShape::hsv:
      return "three pairs of numbers, each the lesser first: hue, saturation, value";
    case WordShape::turn:
      return "\"up\" or \"any\"";
  }
  return "";
}

namespace {

class Reader {
 public:
  Reader(DrawnKind kind, const NumberRange& range, const Complaint& complain)
      : kind_(kind), range_(range), complain_(complain) {}

  std::optional<Distribution> read(const RecipeValue& value);
  std::optional<Distribution> constant(const RecipeValue& value);

 private:
  const DistributionWord* first_word(const RecipeValue& value);
  void read_main(const RecipeValue& value);
  void read_candidates(const RecipeValue& value);
  void read_beside(const std::string& name, const RecipeValue& value);
  void add_around_centre(Numbers& bounds) const;
  void check_bounds(const RecipeValue& value);

  template <typename... Args>
  void complain(const RecipeValue& at, fmt::format_string<Args...> text, Args&&... args) {
    wrong_ = true;
    complain_(at, fmt::format(text, std::forward<Args>(args)...));
  }

  DrawnKind kind_;
  NumberRange range_;
  const Complaint& complain_;
  Distribution to_;
  bool wrong_ = false;
};

/// Words that a key of this kind takes.
std::vector<std::string_view> words_for(DrawnKind kind) {
  std::vector<std::string_view> names;
  for (const DistributionWord& word : distribution_words())
    if (may_draw(word, kind)) names.push_back(word.name);
  return names;
}

bool stands_beside(const DistributionWord& word, std::string_view name) {
  return std::any_of(word.beside.begin(), word.beside.end(), [&](std::string_view one) {
    return one == name || (one.ends_with('!') && one.substr(0, one.size() - 1) == name);
  });
}

bool is_beside_word(std::string_view name) {
  const auto words = distribution_words();
  return std::any_of(words.begin(), words.end(),
                     [&](const DistributionWord& word) { return stands_beside(word, name); });
}

const DistributionWord* Reader::first_word(const RecipeValue& value) {
  const DistributionWord* word = nullptr;
  bool any_unknown = false;
  const std::vector<std::string_view> known = words_for(kind_);
  for (const auto& [name, member] : *value.table()) {
    const DistributionWord* one = find_word(name);
    if (one == nullptr && !is_beside_word(name)) {
      std::vector<std::string_view> all = known;
      all.insert(all.end(), {"within", "weights", "per", "elevation_deg", "azimuth_deg", "at"});
      complain(member, "{{{}}} is no distribution{}", name, known_words(name, all));
      any_unknown = true;
    } else if (one != nullptr && !may_draw(*one, kind_)) {
      complain(member, "{{{}}} gives another kind of value; here stand {}", name,
               fmt::join(known, ", "));
      any_unknown = true;
    } else if (one != nullptr && word != nullptr) {
      complain(member, "must be one distribution, got {} and {}", word->name, name);
      any_unknown = true;
    } else if (one != nullptr) {
      word = one;
    }
  }
  if (word == nullptr && !any_unknown)
    complain(value, "must be a distribution, one of {}, got {}", fmt::join(known, ", "),
             to_toml(value));
  return any_unknown ? nullptr : word;
}

void Reader::read_candidates(const RecipeValue& value) {
  const RecipeValue::Array* list = value.array();
  if (list == nullptr || list->empty())
    return complain(value, "{{{}}} wants {}, got {}", to_.word->name, shape_text(to_.word->shape),
                    to_toml(value));
  for (const RecipeValue& element : *list) {
    if (is_distribution(element) && to_.word->by_view) {
      complain(element, "{{{}}} wants constants, got {}", to_.word->name, to_toml(element));
      continue;
    }
    Reader nested(kind_, range_, complain_);
    std::optional<Distribution> candidate =
        is_distribution(element) ? nested.read(element) : nested.constant(element);
    if (!candidate) {
      wrong_ = true;
      continue;
    }
    std::string name = to_toml(kind_ == DrawnKind::integer ? element : with_numbers(element));
    if (!to_.word->by_view &&
        std::find(to_.names.begin(), to_.names.end(), name) != to_.names.end())
      complain(element, "{{{}}} must name a value once, got {} again; weights favour one",
               to_.word->name, to_toml(element));
    if (candidate->word != nullptr && candidate->per != DrawnPer::view)
      complain(element, "{{{}}} has per, which belongs beside choice", candidate->word->name);
    to_.candidates.push_back(*std::move(candidate));
    to_.names.push_back(std::move(name));
  }
}

void Reader::read_main(const RecipeValue& value) {
  std::optional<Numbers> numbers;
  switch (to_.word->shape) {
    case WordShape::range:
      numbers = range_of(value);
      break;
    case WordShape::parameters:
      numbers = numbers_of(value, 2, 2);
      break;
    case WordShape::candidates:
      return read_candidates(value);
    case WordShape::radius:
      if (value.is_number()) numbers = radii_of(value);
      break;
    case WordShape::radii:
      numbers = radii_of(value);
      break;
    case WordShape::box:
      numbers = rows_of(value, 2, 3);
      break;
    case WordShape::hsv:
      numbers = rows_of(value, 3, 2);
      for (std::size_t i = 0; numbers && i < 6; i += 2)
        if ((*numbers)[i] > (*numbers)[i + 1]) numbers.reset();
      break;
    case WordShape::turn:
      if (value.text() != nullptr && *value.text() == "up") numbers = Numbers{1};
      if (value.text() != nullptr && *value.text() == "any") numbers = Numbers{2};
      break;
  }
  if (!numbers)
    return complain(value, "{{{}}} wants {}, got {}", to_.word->name, shape_text(to_.word->shape),
                    to_toml(value));
  to_.numbers = *std::move(numbers);
}

void Reader::read_beside(const std::string& name, const RecipeValue& value) {
  const auto wants = [&](std::string_view what) {
    complain(value, "{{{}}} wants {} = {}, got {}", to_.word->name, name, what, to_toml(value));
  };
  const auto put_range = [&](std::array<double, 2>& to, double least, double most) {
    const std::optional<Numbers> range = range_of(value);
    if (!range || (*range)[0] < least || (*range)[1] > most)
      return wants(std::isinf(least) ? std::string(k_range_text)
                                     : fmt::format("{}, in [{}, {}]", k_range_text, least, most));
    to = {(*range)[0], (*range)[1]};
  };
  if (name == "within") return put_range(to_.within, -HUGE_VAL, HUGE_VAL);
  if (name == "elevation_deg") return put_range(to_.elevation_deg, -90, 90);
  if (name == "azimuth_deg") return put_range(to_.azimuth_deg, -360, 360);
  if (name == "at") {
    const std::optional<Numbers> point = numbers_of(value, 3, 3);
    if (!point) return wants("three numbers");
    std::copy(point->begin(), point->end(), to_.at.begin());
  } else if (name == "weights") {
    std::optional<Numbers> weights = numbers_of(value, 0, 1 << 20);
    double sum = 0;
    bool negative = false;
    for (const double weight : weights.value_or(Numbers{})) {
      sum += weight;
      negative = negative || weight < 0;
    }
    if (!weights || negative || sum <= 0) return wants("numbers >= 0, not all 0");
    to_.weights = *std::move(weights);
  } else {
    constexpr std::array<std::string_view, 3> k_per = {"view", "model", "dataset"};
    const auto at = value.text() == nullptr ? k_per.end()
                                            : std::find(k_per.begin(), k_per.end(), *value.text());
    if (at == k_per.end()) return wants("\"view\", \"model\" or \"dataset\"");
    to_.per = static_cast<DrawnPer>(at - k_per.begin());
  }
}

void Reader::add_around_centre(Numbers& bounds) const {
  for (const double centre : to_.at)
    bounds.insert(bounds.end(), {centre - to_.numbers[1], centre + to_.numbers[1]});
}

/// Every number it can give must be one that the key may have.
void Reader::check_bounds(const RecipeValue& value) {
  Numbers bounds;
  switch (to_.word->shape) {
    case WordShape::range:
      bounds = to_.numbers;
      if (kind_ == DrawnKind::point) add_around_centre(bounds);
      break;
    case WordShape::parameters:
      bounds = {to_.within[0], to_.within[1]};
      break;
    case WordShape::box:
      bounds = to_.numbers;
      break;
    case WordShape::radius:
    case WordShape::radii:
      add_around_centre(bounds);
      break;
    case WordShape::candidates:  // each was checked
    case WordShape::hsv:
    case WordShape::turn:
      break;
  }
  for (const double bound : bounds)
    if (!range_.contains(bound))
      return complain(value, "{{{}}} must give numbers {}, got {}", to_.word->name, range_.text(),
                      bound);
}

std::optional<Distribution> Reader::constant(const RecipeValue& value) {
  const std::size_t width = width_of(kind_);
  std::optional<Numbers> numbers;
  if (width == 1) {
    if (kind_ == DrawnKind::integer ? value.integer() != nullptr : value.is_number())
      numbers = Numbers{value.number()};
  } else {
    numbers = numbers_of(value, width, width);
  }
  const bool in_range =
      numbers &&
      std::all_of(numbers->begin(), numbers->end(),
                  [&](double number) { return range_.contains(number); }) &&
      (kind_ != DrawnKind::rotation ||
       std::any_of(numbers->begin(), numbers->end(), [](double number) { return number != 0; }));
  if (!in_range) {
    const std::string range = range_.text();
    complain(value, "must choose among {}{}{}, got {}",
             width == 4                    ? "lists of four numbers, not all 0,"
             : width == 3                  ? "lists of three numbers"
             : kind_ == DrawnKind::integer ? "integers"
                                           : "numbers",
             range.empty() ? "" : " ", range, to_toml(value));
    return std::nullopt;
  }
  to_.kind = kind_;
  to_.numbers =
      kind_ == DrawnKind::rotation ? unit_quaternion(*std::move(numbers)) : *std::move(numbers);
  return to_;
}

std::optional<Distribution> Reader::read(const RecipeValue& value) {
  to_.kind = kind_;
  to_.word = first_word(value);
  if (to_.word == nullptr) return std::nullopt;
  const RecipeValue::Table& table = *value.table();
  const RecipeValue& main = table.find(to_.word->name)->second;
  for (const auto& [name, member] : table) {
    if (name == to_.word->name) continue;
    if (stands_beside(*to_.word, name)) {
      read_beside(name, member);
      continue;
    }
    complain(member, "{{{}}} takes no {}{}", to_.word->name, name,
             to_.word->by_view && name == "per" ? ": it goes from view to view" : "");
  }
  read_main(main);
  for (std::string_view name : to_.word->beside) {
    if (!name.ends_with('!')) continue;
    name.remove_suffix(1);
    if (!table.contains(name))
      complain(value, "{{{}}} must have {} = [least, most] beside it", to_.word->name, name);
  }
  if (wrong_) return std::nullopt;
  if (!to_.weights.empty() && to_.weights.size() != to_.candidates.size())
    complain(table.find("weights")->second, "{{{}}} wants {} weights, one a value, got {}",
             to_.word->name, to_.candidates.size(), to_.weights.size());
  if (to_.word->check != nullptr)
    if (const std::string fault = to_.word->check(to_); !fault.empty())
      complain(main, "{{{}}} {}{}", to_.word->name, fault,
               fault.find(", got ") == fault.npos ? ", got " + to_toml(main) : "");
  if (!wrong_) check_bounds(main);
  if (wrong_) return std::nullopt;
  return to_;
}

}  // namespace

std::vector<double> unit_quaternion(std::vector<double> numbers) {
  // By the greatest first: a square neither under- nor overflows.
  double greatest = 0;
  for (const double x : numbers)
    greatest = std::max(greatest, std::fabs(x));
  double sum = 0;
  for (double& x : numbers) {
    x /= greatest;
    sum += x * x;
  }
  for (double& x : numbers)
    x /= std::sqrt(sum);
  return numbers;
}

std::optional<Distribution> read_distribution(const RecipeValue& table, DrawnKind kind,
                                              const NumberRange& range, const Complaint& complain) {
  return Reader(kind, range, complain).read(table);
}

}  // namespace ds
