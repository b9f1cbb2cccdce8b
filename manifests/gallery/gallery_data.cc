// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/gallery_data.h"

#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

using Write = std::function<void(const std::string&, std::string_view)>;

/// What the page shows of an image's line: nothing of the film but the error's interval, and of its
/// files the path and one checksum.
json shown_line(json line, const ImageExtras& extras, const std::vector<std::string>& previews) {
  for (const char* key : {"parts", "files_key", "camera_convention"})
    line.erase(key);
  if (const auto film = line.find("film"); film != line.end()) {
    json kept = json::object();
    for (const char* key : {"error_low", "error_high", "samples", "capped"})
      if (film->contains(key)) kept[key] = (*film)[key];
    *film = std::move(kept);
  }
  for (json& file : line["files"])
    file = {{"kind", file["kind"]}, {"path", file["path"]}, {"xxh128", file["xxh128"]}};
  if (extras.box && !line.contains("box")) line["box"] = *extras.box;
  if (!previews.empty()) line["previews"] = previews;
  return line;
}

/// One kind of file that images have, and how its path follows from the image's id.
struct Kind {
  std::string ending;
  bool preview = false;
};

std::string regular_path(const std::string& id, const std::string& ending) {
  return "images/" + id + ending;
}

std::map<std::string, Kind> kinds_of(const std::vector<ImageRecord>& images,
                                     const MadeFiles& made) {
  std::map<std::string, Kind> kinds;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string stem = regular_path(images[i].id, "");
    for (const FileRecord& file : images[i].files)
      if (file.path.starts_with(stem))
        kinds.try_emplace(file.kind, Kind{file.path.substr(stem.size())});
    for (const std::string& kind : made.previews[i])
      if (const auto at = kinds.find(kind); at != kinds.end()) at->second.preview = true;
  }
  return kinds;
}

json meta_columns(const std::vector<GalleryColumn>& columns) {
  json list = json::array();
  for (const GalleryColumn& column : columns) {
    json row{{"key", column.key}, {"label", column.label}};
    if (!column.unit.empty()) row["unit"] = column.unit;
    if (column.type == GalleryColumn::Type::list) {
      row["type"] = "list";
      row["values"] = column.values;
    } else {
      row["type"] = "number";
    }
    list.push_back(std::move(row));
  }
  return list;
}

std::string joined(std::size_t begin, std::size_t end,
                   const std::function<std::string(std::size_t)>& text) {
  std::string list = "[";
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin) list += ',';
    list += text(i);
  }
  return list + "]";
}

/// Paths that do not follow from the id, by kind and image; "{}" of most datasets.
json odd_paths(const std::vector<ImageRecord>& images, const std::map<std::string, Kind>& kinds,
               std::size_t begin, std::size_t end) {
  json paths = json::object();
  for (std::size_t i = begin; i < end; ++i) {
    std::set<std::string> own;
    for (const FileRecord& file : images[i].files) {
      own.insert(file.kind);
      const auto kind = kinds.find(file.kind);
      if (kind == kinds.end() || regular_path(images[i].id, kind->second.ending) != file.path)
        paths[file.kind][std::to_string(i)] = file.path;
    }
    for (const auto& [name, kind] : kinds)
      if (!own.contains(name)) paths[name][std::to_string(i)] = nullptr;
  }
  return paths;
}

/// First and count of each run of images that follow each other.
json runs_of(const std::vector<std::string>& ids,
             const std::map<std::string_view, std::size_t>& places) {
  std::set<std::size_t> images;
  for (const std::string& id : ids)
    if (const auto at = places.find(id); at != places.end()) images.insert(at->second);
  json runs = json::array();
  std::size_t next = 0, count = 0;
  for (const std::size_t image : images) {
    if (count > 0 && image == next) {
      runs.back() = ++count;
    } else {
      runs.push_back(image);
      runs.push_back(count = 1);
    }
    next = image + 1;
  }
  return runs;
}

json checks_of(const std::vector<CheckFinding>& findings, const std::vector<ImageRecord>& images) {
  std::map<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < images.size(); ++i)
    places.emplace(images[i].id, i);
  json list = json::array();
  for (const CheckFinding& finding : findings) {
    json object = to_json_value(finding);
    object["images"] = runs_of(finding.images, places);
    list.push_back(std::move(object));
  }
  return list;
}

void write_grid(const std::vector<ImageRecord>& images, const std::vector<GalleryColumn>& columns,
                const std::map<std::string, Kind>& kinds, const MadeFiles& made, std::size_t chunk,
                const Write& write) {
  const std::size_t begin = chunk * k_grid_chunk;
  const std::size_t end = std::min(begin + k_grid_chunk, images.size());
  std::string text = fmt::format("gallery.grid({},{{\"id\":", chunk);
  text += joined(begin, end, [&](std::size_t i) { return json(images[i].id).dump(); });
  for (const GalleryColumn& column : columns) {
    text += fmt::format(",\n{}:", json(column.key).dump());
    text += joined(begin, end, [&](std::size_t i) {
      if (column.type == GalleryColumn::Type::number) return short_json_number(column.numbers[i]);
      const auto at = std::lower_bound(column.values.begin(), column.values.end(), column.texts[i],
                                       as_people_count);
      return std::to_string(at - column.values.begin());
    });
  }
  text += ",\n\"box\":";
  text += joined(begin, end, [&](std::size_t i) -> std::string {
    const auto& box = made.extras[i].box;
    return box ? fmt::format("{}", fmt::join(*box, ",")) : "-1,-1,-1,-1";
  });
  text +=
      fmt::format(",\n\"paths\":{}}});\n", canonical_json(odd_paths(images, kinds, begin, end)));
  write(fmt::format("data/grid-{}.js", chunk), text);
}

}  // namespace

void write_gallery_data(const GalleryFacts& facts, const std::vector<std::string>& lines,
                        const std::vector<ImageRecord>& images, const MadeFiles& made,
                        const Write& write) {
  DS_ASSERT(lines.size() == images.size());
  GalleryColumns collected;
  std::string chunk;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    json line = json::parse(lines[i]);
    collected.add(line, made.extras[i]);
    chunk += chunk.empty() ? fmt::format("gallery.image({},[\n", i / k_image_chunk) : ",\n";
    chunk += canonical_json(shown_line(std::move(line), made.extras[i], made.previews[i]));
    if ((i + 1) % k_image_chunk != 0 && i + 1 < lines.size()) continue;
    write(fmt::format("data/image-{:03}.js", i / k_image_chunk), chunk + "\n]);\n");
    chunk.clear();
  }
  const std::vector<GalleryColumn> columns = std::move(collected).take();
  const std::map<std::string, Kind> kinds = kinds_of(images, made);
  for (std::size_t i = 0; i * k_grid_chunk < images.size(); ++i)
    write_grid(images, columns, kinds, made, i, write);

  json meta{{"format", k_gallery_format},
            {"name", facts.dataset.name},
            {"version", facts.dataset.dsbuild_version},
            {"licence", facts.dataset.licence},
            {"n", images.size()},
            {"chunk", k_grid_chunk},
            {"image_chunk", k_image_chunk},
            {"root", facts.root},
            {"columns", meta_columns(columns)},
            {"kinds", json::array()},
            {"counts", json::object()},
            {"conventions", facts.conventions},
            {"checks", checks_of(facts.findings, images)},
            {"broken", made.broken},
            {"notes", facts.notes},
            {"recipe", facts.dataset.recipe_text}};
  for (const auto& [name, kind] : kinds)
    meta["kinds"].push_back({{"kind", name}, {"ending", kind.ending}, {"preview", kind.preview}});
  for (const auto& [name, count] : facts.dataset.counts)
    meta["counts"][name] = count;
  for (const auto& [name, plane] : facts.dataset.planes)
    meta["planes"][name] = plane.convention;
  for (const LicenceRecord& licence : facts.dataset.licences)
    meta["licences"].push_back({{"spdx", licence.spdx}, {"assets", licence.assets}});
  for (const SourceRecord& source : facts.dataset.sources)
    meta["sources"].push_back(
        {{"url", source.url}, {"text", source.text}, {"assets", source.assets}});
  write("data/meta.js", fmt::format("gallery.meta({});\n", canonical_json(meta)));
}

}  // namespace ds
