// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/hash_index.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ds {
namespace {

struct Rows {
  std::vector<Hash128> hashes;
  HashIndex index;

  explicit Rows(std::vector<Hash128> rows)
      : hashes(std::move(rows)),
        index(hashes.size(), [this](std::size_t i) { return hashes[i]; }) {}
  std::optional<std::size_t> find(Hash128 hash) const {
    return index.find(hash, [this](std::size_t i) { return hashes[i]; });
  }
};

TEST(HashIndex, FindsEveryRowAndNothingElse) {
  std::vector<Hash128> hashes;
  for (int i = 0; i < 1000; ++i)
    hashes.push_back(hash_text(std::to_string(i)));
  const Rows rows(hashes);
  for (std::size_t i = 0; i < hashes.size(); ++i)
    EXPECT_EQ(rows.find(hashes[i]), i);
  for (int i = 1000; i < 3000; ++i)
    EXPECT_EQ(rows.find(hash_text(std::to_string(i))), std::nullopt);
}

TEST(HashIndex, TellsApartRowsOfOneSlot) {
  const Rows rows({{1, 0}, {2, 0}, {3, 0}, {4, 1}});
  for (std::uint64_t high = 1; high <= 3; ++high)
    EXPECT_EQ(rows.find({high, 0}), high - 1);
  EXPECT_EQ(rows.find({4, 1}), 3U);
  EXPECT_EQ(rows.find({4, 0}), std::nullopt);
}

TEST(HashIndex, GivesTheFirstOfEqualRows) {
  EXPECT_EQ(Rows({{1, 7}, {1, 7}}).find({1, 7}), 0U);
}

TEST(HashIndex, OfNoRowsFindsNothing) {
  EXPECT_EQ(HashIndex().find({}, [](std::size_t) { return Hash128{}; }), std::nullopt);
  EXPECT_EQ(Rows({}).find({1, 1}), std::nullopt);
}

}  // namespace
}  // namespace ds
