// SPDX-License-Identifier: Apache-2.0
#include "builder/db/unused_texts.h"

#include "builder/db/hash_column.h"
#include "builder/db/named_products.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace ds {
namespace {

constexpr std::size_t k_digits = 32;

/// Texts that a text refers to. Whatever looks like a reference is taken for one.
std::vector<Hash128> references(std::string_view body) {
  std::vector<Hash128> found;
  for (std::size_t at = body.find('@'); at != body.npos; at = body.find('@', at + 1))
    if (const auto hash = Hash128::from_hex(body.substr(at + 1, k_digits))) found.push_back(*hash);
  return found;
}

}  // namespace

std::vector<Hash128> unused_texts(Database& database, const std::set<std::string>& without) {
  std::vector<std::pair<Hash128, bool>> texts;      // by hash; whether it is used
  std::vector<std::pair<Hash128, Hash128>> refers;  // from, to; by from
  {
    Statement row = database.connection().prepare("SELECT hash, body FROM text ORDER BY hash");
    while (row.step()) {
      texts.emplace_back(hash_column(row, 0), false);
      for (const Hash128 to : references(row.view(1)))
        refers.emplace_back(texts.back().first, to);
    }
  }
  std::vector<Hash128> to_look_at;
  const auto use = [&](Hash128 hash) {
    const auto at = std::lower_bound(texts.begin(), texts.end(), std::pair(hash, false));
    if (at == texts.end() || at->first != hash || at->second) return;
    at->second = true;
    to_look_at.push_back(hash);
  };
  visit_all_images(database, [&](const std::string& dataset, const PartHashes& parts) {
    if (!without.contains(dataset)) std::for_each(parts.begin(), parts.end(), use);
  });
  while (!to_look_at.empty()) {
    const Hash128 from = to_look_at.back();
    to_look_at.pop_back();
    for (auto at = std::lower_bound(refers.begin(), refers.end(), std::pair(from, Hash128{}));
         at != refers.end() && at->first == from; ++at)
      use(at->second);
  }
  std::vector<Hash128> unused;
  for (const auto& [hash, is_used] : texts)
    if (!is_used) unused.push_back(hash);
  return unused;
}

void remove_text(Database& database, Hash128 hash) {
  database.connection().prepare("DELETE FROM text WHERE hash = ?1").bind(1, hash.hex()).run();
}

}  // namespace ds
