// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/recipe/recipe.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"
#include "tracer/base/text_width.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>

namespace ds {
namespace {

struct Count {
  std::uint64_t models = 0, images = 0;

  Count& operator+=(const Count& other) {
    models += other.models;
    images += other.images;
    return *this;
  }
};

/// Of one class, or of one and those below it.
struct ClassCounts {
  Count all;
  std::map<std::string, Count> splits;  ///< "" is none

  void add(const ClassCounts& other) {
    all += other.all;
    for (const auto& [split, count] : other.splits)
      splits[split] += count;
  }
};

void check_hierarchy(const Recipe& recipe, const std::string& name) {
  std::vector<std::string_view> known;
  for (const Hierarchy& hierarchy : recipe.hierarchies)
    known.push_back(hierarchy.name);
  if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end())
    fail(ErrorKind::usage, "--classes: wanted {}, got {}{}",
         known.empty() ? "none, the recipe has no classes.more"
                       : fmt::format("{}", fmt::join(known, " or ")),
         name, did_you_mean(name, known));
}

/// By class path; "" is none.
std::map<std::string, ClassCounts> count_classes(const Recipe& recipe,
                                                 const std::string& hierarchy) {
  std::map<std::string, ClassCounts> classes;
  Shared<std::string> model;  // of the image before: a model's images follow each other
  expand(recipe, [&](const ImageSpec& image) {
    const bool new_model = !model.is_same(image.model_name);
    model = image.model_name;
    const std::string& path =
        hierarchy.empty() ? *image.class_path : image.other_classes->at(hierarchy);
    ClassCounts one;
    one.all = {new_model ? 1U : 0U, 1};
    one.splits[*image.split] = one.all;
    classes[path].add(one);
  });
  return classes;
}

/// A class above others counts those.
std::map<std::string, ClassCounts> with_parents(const std::map<std::string, ClassCounts>& classes) {
  std::map<std::string, ClassCounts> all;
  for (const auto& [path, counts] : classes)
    for (std::string of = path;;) {
      all[of].add(counts);
      const std::size_t slash = of.rfind('/');
      if (slash == of.npos) break;
      of.resize(slash);
    }
  return all;
}

/// A class stands behind the one above it, whatever its name has before a "/".
struct ByParts {
  bool operator()(const std::string& a, const std::string& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
      return (x == '/' ? 0 : static_cast<unsigned char>(x)) <
             (y == '/' ? 0 : static_cast<unsigned char>(y));
    });
  }
};

std::string padded(std::string text, int columns) {
  const int lacking = columns - columns_of(text);
  if (lacking > 0) text.append(static_cast<std::size_t>(lacking), ' ');
  return text;
}

void print_table(const std::map<std::string, ClassCounts>& classes, const ClassIds& ids,
                 const std::vector<std::string>& splits) {
  std::string header = fmt::format("{:>4}  {:<32} {:>8} {:>8}", "id", "class", "models", "images");
  for (const std::string& split : splits)
    header += fmt::format(" {:>8}", split);
  say(Stream::result, "{}\n", header);
  const std::map<std::string, ClassCounts, ByParts> in_order(classes.begin(), classes.end());
  for (const auto& [path, counts] : in_order) {
    const auto id = ids.find(path);
    const auto depth = static_cast<std::size_t>(std::count(path.begin(), path.end(), '/'));
    const std::string name = path.empty()
                                 ? "(without a class)"
                                 : std::string(2 * depth, ' ') + path.substr(path.rfind('/') + 1);
    std::string line =
        fmt::format("{:>4}  {} {:>8} {:>8}", id == ids.end() ? "" : std::to_string(id->second),
                    padded(name, 32), counts.all.models, counts.all.images);
    for (const std::string& split : splits) {
      const auto at = counts.splits.find(split);
      line += fmt::format(" {:>8}", at == counts.splits.end() ? 0 : at->second.models);
    }
    say(Stream::result, "{}\n", line);
  }
}

nlohmann::json classes_json(const std::map<std::string, ClassCounts>& classes,
                            const ClassIds& ids) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [path, counts] : classes) {
    const auto id = ids.find(path);
    nlohmann::json splits = nlohmann::json::object();
    for (const auto& [split, count] : counts.splits)
      splits[split] = {{"models", count.models}, {"images", count.images}};
    list.push_back({{"path", path},
                    {"id", id == ids.end() ? nlohmann::json() : nlohmann::json(id->second)},
                    {"models", counts.all.models},
                    {"images", counts.all.images},
                    {"splits", splits}});
  }
  return list;
}

/// Of the classification that images are labelled with classes.ids decides; of another the order.
ClassIds ids_of(const Recipe& recipe, const std::map<std::string, ClassCounts>& classes,
                const std::string& hierarchy) {
  std::set<std::string> paths;
  for (const auto& [path, counts] : classes)
    paths.insert(path);
  return class_ids(hierarchy.empty() ? recipe : Recipe{}, paths);
}

}  // namespace

int run_classes(const Arguments& arguments) {
  RealDisk disk;
  const Recipe recipe = open_dataset(arguments.request(), Access::inputs, disk).recipe;
  check_hierarchy(recipe, arguments.hierarchy);
  std::map<std::string, ClassCounts> classes = count_classes(recipe, arguments.hierarchy);
  const ClassIds ids = ids_of(recipe, classes, arguments.hierarchy);
  for (const auto& [path, id] : ids)
    classes.try_emplace(path);  // named by classes.ids, and of no image
  if (arguments.ids) {
    std::vector<std::string_view> lines(ids.size());
    for (const auto& [path, id] : ids)
      lines[id] = path;
    for (const std::string_view line : lines)
      say(Stream::result, "{}\n", line);
    return 0;
  }
  const std::map<std::string, ClassCounts> tree = with_parents(classes);
  if (arguments.json) {
    nlohmann::json hierarchies = nlohmann::json::array();
    for (const Hierarchy& hierarchy : recipe.hierarchies)
      hierarchies.push_back(hierarchy.name);
    print_json({{"classes", classes_json(tree, ids)}, {"hierarchies", hierarchies}});
    return 0;
  }
  std::set<std::string> splits;
  for (const auto& [path, counts] : tree)
    for (const auto& [split, count] : counts.splits)
      if (!split.empty()) splits.insert(split);
  print_table(tree, ids, {splits.begin(), splits.end()});
  for (const Hierarchy& hierarchy : recipe.hierarchies)
    if (arguments.hierarchy.empty())
      say(Stream::result, "also {}: --classes {}\n", hierarchy.name, hierarchy.name);
  return 0;
}

}  // namespace ds
