// SPDX-License-Identifier: Apache-2.0
#include "builder/store/made_record.h"

#include "manifests/film_facts.h"
#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
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

/// Goes behind the next `,"NAME":`, and what it is written before. A quote inside a text has a backslash before it,
/// so this stands between members only.
bool find_member(std::string_view& rest, std::string_view name) {
  const std::size_t at = rest.find(name);
  if (at == rest.npos) return false;
  rest.remove_prefix(at + name.size());
  return true;
}

std::optional<Hash128> hash_ahead(std::string_view rest) {
  constexpr std::size_t k_digits = 32;
  if (rest.size() <= k_digits || rest[k_digits] != '"') return std::nullopt;
  return Hash128::from_hex(rest.substr(0, k_digits));
}

/// Of a line without its break. Nothing for one that `to_record` did not write.
std::optional<RecordLine> glance_at_line(std::string_view line) {
  std::string_view rest = line;
  if (!rest.starts_with(R"({"device":")") || !rest.ends_with('}')) return std::nullopt;
  RecordLine found;
  if (!find_member(rest, R"(,"key":")")) return std::nullopt;
  const std::optional<Hash128> key = hash_ahead(rest);
  if (!find_member(rest, R"(,"kind":")")) return std::nullopt;
  found.kind = rest.substr(0, rest.find('"'));
  if (!find_member(rest, R"(,"object":")")) return std::nullopt;
  const std::optional<Hash128> object = hash_ahead(rest);
  if (!find_member(rest, R"(,"pixels":")") || !hash_ahead(rest)) return std::nullopt;
  for (const std::string_view name :
       {R"(,"rejected_samples":)", R"(,"relative_error":)", R"(,"seconds":)", R"(,"sha256":")",
        R"(,"size_bytes":)", R"(,"tone_map_scale":)"})
    if (!find_member(rest, name)) return std::nullopt;
  if (!key || !object || found.kind.find('\\') != found.kind.npos) return std::nullopt;
  found.key = *key;
  found.object = *object;
  return found;
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

std::vector<RecordLine> record_lines(std::string_view text) {
  std::vector<RecordLine> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    std::optional<RecordLine> found = glance_at_line(line);
    if (!found) {
      // One that is none throws; of another way of writing it, only the order of members is another.
      const Product product = from_record(std::string(line) + '\n').at(0).product;
      found = {{}, product.key, product.object, product.kind};
    }
    found->text = text.substr(0, std::min(end + 1, text.size()));
    lines.push_back(*found);
    text.remove_prefix(found->text.size());
  }
  return lines;
}

}  // namespace ds
