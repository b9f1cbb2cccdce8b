// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/made_record.h"

#include "manifests/whole_folder.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

namespace ds {
namespace {

TEST(MadeRecord, ReadsWhatItWrites) {
  const Hash128 source = hash_text("a"), other = hash_text("b");
  MadeRecord record;
  record.add("thumbnail", source, {hash_text("file"), "t/00/00000.jpg", {0.25, 0.1}});
  record.add("thumbnail", source, {hash_text("again"), "t/00/00001.jpg", {}});
  record.add("box", other, {{}, "", {1, 2, 3, 4}});
  record.add("box", source, {{}, "", {}});
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / k_gallery_folder.record, record.text());
  const MadeRecord read(folder.path());
  EXPECT_EQ(read.text(), record.text());
  ASSERT_NE(read.find("thumbnail", source), nullptr);
  EXPECT_EQ(read.find("thumbnail", source)->path, "t/00/00000.jpg");
  EXPECT_EQ(read.find("thumbnail", source)->facts, (std::vector<double>{0.25, 0.1}));
  EXPECT_EQ(read.find("box", other)->facts, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_TRUE(read.find("box", source)->path.empty());
  EXPECT_EQ(read.find("box", hash_text("c")), nullptr);
  EXPECT_EQ(read.find("depth", source), nullptr);
}

TEST(MadeRecord, WhatIsNoRecordIsNone) {
  const TemporaryFolder folder;
  const std::string text = MadeRecord().text();
  for (const std::string& bad :
       {std::string(), std::string("dsbuild gallery 0\n"), text + "box x - - -\n",
        text + "box " + hash_text("a").hex() + " - - 1,x\n", text + "\n\n", text + "box"}) {
    write_file_atomic(folder.path() / k_gallery_folder.record, bad);
    EXPECT_EQ(MadeRecord(folder.path()).text(), text) << bad;
  }
  EXPECT_EQ(MadeRecord(folder.path() / "not there").text(), text);
}

}  // namespace
}  // namespace ds
