// SPDX-License-Identifier: Apache-2.0
// What of a program's text its key takes: tokens, whatever their layout.
#include "tracer/device/program_tokens.h"

#include "tracer/base/files.h"
#include "tracer/kernels/embedded.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace ds {
namespace {

TEST(ProgramTokens, AreTokensInOneSpelling) {
  EXPECT_EQ(program_tokens("a  // one\n\n/* two\n three */ b\nc /* d */ e  \n// f"), "a b c e\n");
  EXPECT_EQ(program_tokens(""), "");
  EXPECT_EQ(program_tokens("/* not closed"), "");
  EXPECT_EQ(program_tokens("x = a/b *c\r\n"), "x=a/b*c\n");
  EXPECT_EQ(program_tokens("#  if A\nb( c ) ;\n#endif // A\nd"), "#if A\nb(c) ;\n#endif\nd\n");
  EXPECT_EQ(program_tokens("#define F( x ) \\\n  g( x )\nh"), "#define F(x)g(x)\nh\n");
  EXPECT_EQ(program_tokens("a // goes on \\\n still a comment\nb"), "a b\n");
  EXPECT_EQ(program_tokens("\"a // b\"  c"), "\"a // b\"c\n");
}

TEST(ProgramTokens, AreOthersWhereTheProgramIs) {
  const std::pair<const char*, const char*> different[] = {
      {"a b", "ab"},
      {"a + +b", "a ++b"},
      {"a = = b", "a == b"},
      {"a < <b", "a <<b"},
      {"1e +5", "1e+5"},
      {"1 .f", "1.f"},
      {"#define f(x)", "#define f (x)"},
      {"#define f a", "#define fa"},
      {"#if A\nb\n#endif", "#if A b\n#endif"},
      {"f(\"a b\")", "f(\"a  b\")"},
      {"a /* */ b", "a b b"},
  };
  for (const auto& [a, b] : different)
    EXPECT_NE(program_tokens(a), program_tokens(b)) << a;
}

/// Every break of a line that C allows, doubled, and blanks wherever two tokens stand apart.
TEST(ProgramTokens, AnotherLayoutOfAKernelFileChangesNone) {
  for (const EmbeddedFile& file : std::span(k_embedded_files, k_embedded_file_count)) {
    const std::string text(file.text);
    std::string other = "// a remark at the start\n";
    bool directive = false, goes_on = false, quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool line_start = i == 0 || text[i - 1] == '\n';
      if (line_start && !goes_on) directive = text[i] == '#';
      goes_on = text.compare(i, 2, "\\\n") == 0 || (goes_on && !line_start && text[i] != '\n');
      if (text[i] == '"') quoted = !quoted;
      if (text[i] == '\n' && !(i > 0 && text[i - 1] == '\\'))
        other += "  // a remark /* at an end\n\n\t";
      else if (text[i] == ' ' && !quoted)
        other += directive ? " \\\n  " : "   ";
      else
        other += text[i];
    }
    EXPECT_EQ(program_tokens(other), program_tokens(text)) << file.path;
  }
}

/// They are in no program (host.h), and the formatter may break their literals.
std::string without_host_parts(std::string_view text) {
  constexpr std::string_view k_start = "#ifdef DS_HOOK_HOST\n", k_end = "#endif\n";
  std::string kept;
  for (std::size_t at = text.find(k_start); at != text.npos; at = text.find(k_start)) {
    kept += text.substr(0, at);
    text.remove_prefix(text.find(k_end, at) + k_end.size());
  }
  return kept + std::string(text);
}

TEST(ProgramTokens, TheFormatterChangesNone) {
  if (std::system("clang-format-14 --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no clang-format-14";
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out.c", in = folder.path() / "in.c";
  for (const EmbeddedFile& file : std::span(k_embedded_files, k_embedded_file_count)) {
    const std::string text = without_host_parts(file.text);
    write_file_atomic(in, std::string_view(text));
    for (const char* style : {"{BasedOnStyle: LLVM, ColumnLimit: 60, SortIncludes: false}",
                              "{BasedOnStyle: GNU, ColumnLimit: 140, SortIncludes: false}"}) {
      ASSERT_EQ(
          std::system(
              fmt::format("clang-format-14 --style='{}' '{}' > '{}'", style, in, out).c_str()),
          0);
      const std::string formatted = read_text_file(out);
      EXPECT_NE(formatted, text) << file.path;
      EXPECT_EQ(program_tokens(formatted), program_tokens(text)) << file.path << ", " << style;
    }
  }
}

}  // namespace
}  // namespace ds
