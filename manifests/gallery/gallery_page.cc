// SPDX-License-Identifier: Apache-2.0
#include "manifests/gallery/gallery_page.h"

#include "tracer/base/error.h"

#include <string_view>

namespace ds {
namespace {

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else if (c == '>')
      html += "&gt;";
    else if (c == '"')
      html += "&quot;";
    else
      html += c;
  }
  return html;
}

/// A path as an address: all but letters, digits and what stands for itself there in per cent.
std::string address(std::string_view path) {
  std::string text;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/._-~").find(c) != std::string_view::npos;
    text += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

void put(std::string& page, std::string_view mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  DS_ASSERT(at != page.npos);
  page.replace(at, mark.size(), text);
}

std::string without_scripts(const GalleryFacts& facts) {
  std::string html = "<h1>" + escaped(facts.dataset.name) +
                     "</h1><p>This page shows the pictures with JavaScript, which is switched off "
                     "here.</p><ul>";
  for (const auto& [name, count] : facts.dataset.counts)
    html += fmt::format("<li>{}: {}</li>", escaped(name), count);
  html += "</ul><p>";
  for (const char* file : {"manifest/dataset.json", "manifest/images.jsonl"})
    html += fmt::format("<a href=\"{}\">{}</a> ", address(facts.root + "/" + file), file);
  return html + "</p>";
}

}  // namespace

std::string gallery_page(const GalleryFacts& facts) {
  std::string page;
  for (const char* const* part = k_gallery_page; *part != nullptr; ++part)
    page += *part;
  // The marks stand before what is put in for the first, so that no name is taken for one.
  put(page, "<!--without scripts-->", without_scripts(facts));
  put(page, "<!--dataset-->", escaped(facts.dataset.name));
  return page;
}

}  // namespace ds
