// SPDX-License-Identifier: Apache-2.0
#include "builder/store/made_record.h"

#include "manifests/film_facts.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace ds {
namespace {

using nlohmann::json;

Hash128 hash_field(const json& object, const char* name) {
  const std::string text = object.at(name).get<std::string>();
  const std::optional<Hash128> hash = Hash128::from_hex(text);
  if (!hash)
    throw UnreadableRecord(
        fmt::format("a record of the store: {} must be a hash, got \"{}\"", name, text));
  return *hash;
}

MadeProduct from_line(const std::string& line) {
  const json object = json::parse(line);
  MadeProduct made;
  made.product.key = hash_field(object, "key");
  made.product.kind = object.at("kind").get<std::string>();
  made.product.object = hash_field(object, "object");
  made.product.size_bytes = object.at("size_bytes").get<std::uint64_t>();
  made.product.sha256 = object.at("sha256").get<std::string>();
  made.product.pixels = hash_field(object, "pixels");
  made.product.tone_map_scale = object.at("tone_map_scale").get<double>();
  made.product.rejected_samples = object.at("rejected_samples").get<std::uint64_t>();
  if (const json& error = object.at("relative_error"); !error.is_null())
    made.product.relative_error = error.get<double>();
  if (const auto facts = object.find("facts"); facts != object.end())
    made.product.facts = film_facts_from(*facts);
  if (const auto counts = object.find("pixel_counts"); counts != object.end())
    made.product.pixel_counts = pixel_counts_from(*counts);
  made.run.seconds = object.at("seconds").get<double>();
  made.run.device = object.at("device").get<std::string>();
  return made;
}

}  // namespace

std::string to_record(const std::vector<MadeProduct>& made) {
  std::string text;
  for (const auto& [product, run] : made) {
    const json object{
        {"key", product.key.hex()},
        {"kind", product.kind},
        {"object", product.object.hex()},
        {"size_bytes", product.size_bytes},
        {"sha256", product.sha256},
        {"pixels", product.pixels.hex()},
        {"tone_map_scale", product.tone_map_scale},
        {"rejected_samples", product.rejected_samples},
        {"relative_error", product.relative_error ? json(*product.relative_error) : json()},
        {"facts", to_json_value(product.facts)},
        {"pixel_counts", to_json_value(product.pixel_counts)},
        {"seconds", run.seconds},
        {"device", run.device}};
    text += object.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
  }
  return text;
}

std::vector<MadeProduct> from_record(const std::string& text) {
  std::vector<MadeProduct> made;
  std::istringstream lines(text);
  try {
    for (std::string line; std::getline(lines, line);)
      made.push_back(from_line(line));
  } catch (const UnreadableRecord&) {
    throw;
  } catch (const Error& error) {
    throw UnreadableRecord(fmt::format("a record of the store cannot be read: {}", error.what()));
  } catch (const json::exception& error) {
    throw UnreadableRecord(
        fmt::format("a record of the store cannot be read: {}", json_fault(error)));
  }
  return made;
}

}  // namespace ds
