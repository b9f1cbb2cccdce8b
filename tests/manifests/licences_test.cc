// SPDX-License-Identifier: Apache-2.0
#include "manifests/licences.h"

#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace ds {
namespace {

TEST(LicenceNames, AreTheUsualOnesInAnyCase) {
  for (const char* name :
       {"LICENSE", "LICENCE", "License.md", "licence.txt", "COPYING", "copying.txt", "UNLICENSE",
        "LICENSE-MIT", "LICENSE_CC0.txt", "LICENSE-CC-BY-4.0", "LICENSE.CC-BY-4.0",
        "COPYING.LESSER", "LICENSE.rst", "LICENSES.md", "LICENSE.MIT"})
    EXPECT_TRUE(is_licence_name(name)) << name;
  for (const char* name :
       {"license-plate.off", "LICENSE.obj", "licensed.txt", "copyingmachine.ply", "license.pdf",
        "README.md", "NOTICE", "my-license.txt", "licensee", "license_plate.glb", ""})
    EXPECT_FALSE(is_licence_name(name)) << name;
  EXPECT_TRUE(is_licence_folder_name("LICENSES"));
  EXPECT_TRUE(is_licence_folder_name("licences"));
  EXPECT_FALSE(is_licence_folder_name("license"));
  for (const char* name : {"SOURCE", "Source.md", "sources.txt"})
    EXPECT_TRUE(is_source_name(name)) << name;
  for (const char* name : {"source.off", "source-code.txt", "resource"})
    EXPECT_FALSE(is_source_name(name)) << name;
}

TEST(SpdxId, IsThatOfTheKnownTexts) {
  EXPECT_EQ(spdx_id(read_text_file(std::filesystem::path(DS_SOURCE_DIR) / "assets/LICENSE")),
            "CC0-1.0");
  EXPECT_EQ(spdx_id("                                 Apache License\n   Version 2.0, January"),
            "Apache-2.0");
  EXPECT_EQ(spdx_id("Licensed under the Apache License, Version 2.0 (the \"License\")"),
            "Apache-2.0");
  EXPECT_EQ(spdx_id("MIT License\n\nCopyright (c) 2001 A. Nother\n\nPermission is hereby granted, "
                    "free of charge, to any person obtaining a copy\r\nof this software and "
                    "associated documentation files (the \"Software\"), to deal"),
            "MIT");
  EXPECT_EQ(spdx_id("Attribution 4.0 International\n"), "CC-BY-4.0");
  EXPECT_EQ(spdx_id("Attribution-ShareAlike 4.0 International\n"), "CC-BY-SA-4.0");
  EXPECT_EQ(spdx_id("Attribution-NonCommercial-ShareAlike 4.0 International"), "CC-BY-NC-SA-4.0");
}

TEST(SpdxId, TellsTheBsdLicencesApart) {
  const std::string two = "Redistribution and use in source and binary forms, with or without";
  EXPECT_EQ(spdx_id(two), "BSD-2-Clause");
  EXPECT_EQ(spdx_id(two + "\nmay be used to endorse or promote products derived\nfrom this "
                          "software without specific prior written permission."),
            "BSD-3-Clause");
}

TEST(SpdxId, TakesTheOneThatIsStated) {
  EXPECT_EQ(spdx_id("# SPDX-License-Identifier: MIT OR Apache-2.0\r\nwhatever"),
            "MIT OR Apache-2.0");
  EXPECT_EQ(spdx_id("/* SPDX-License-Identifier: GPL-3.0-or-later */"), "GPL-3.0-or-later");
  EXPECT_EQ(spdx_id("SPDX-License-Identifier:"), "");
}

TEST(SpdxId, IsEmptyWhereTheTextDoesNotTell) {
  EXPECT_EQ(spdx_id(""), "");
  EXPECT_EQ(spdx_id("all rights reserved"), "");
  EXPECT_EQ(spdx_id("models: CC0 1.0 Universal; pictures: Attribution 4.0 International"), "");
  EXPECT_EQ(spdx_id("GNU GENERAL PUBLIC LICENSE\nVersion 3, 29 June 2007"), "");
}

TEST(GroupLicences, HoldsEachTextOnce) {
  const auto licences = group_licences({{"models/b.ply", "x"},
                                        {"materials/m.mat", "y"},
                                        {"models/a.ply", "x"},
                                        {"models/a.ply", "x"}});
  ASSERT_EQ(licences.size(), 2u);
  EXPECT_EQ(licences[0], (LicenceRecord{"", "y", {"materials/m.mat"}}));
  EXPECT_EQ(licences[1], (LicenceRecord{"", "x", {"models/a.ply", "models/b.ply"}}));
  EXPECT_TRUE(group_licences({}).empty());
}

}  // namespace
}  // namespace ds
