// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <fstream>  // tinygltf takes it for granted

#define TINYGLTF_IMPLEMENTATION
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/scene/gltf_file.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_magic = "glTF";
constexpr std::size_t k_header = 12, k_chunk_header = 8;
constexpr std::uint32_t k_json_chunk = 0x4e4f534a;  // "JSON"

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

bool is_binary(std::string_view bytes) {
  return bytes.starts_with(k_magic);
}

/// The JSON text; of a binary file its first chunk.
std::string_view json_of(std::string_view bytes, const std::string& name) {
  if (!is_binary(bytes)) return bytes;
  if (bytes.size() < k_header + k_chunk_header)
    fail(ErrorKind::asset, "{}: cut off: a binary glTF file begins with 20 bytes, found {}", name,
         bytes.size());
  const std::uint32_t version = little_endian(bytes, 4), size = little_endian(bytes, 8);
  if (version != 2)
    fail(ErrorKind::asset, "{}: wanted glTF of version 2, found version {}", name, version);
  if (size > bytes.size())
    fail(ErrorKind::asset, "{}: cut off: the header promises {} bytes, found {}", name, size,
         bytes.size());
  const std::uint32_t length = little_endian(bytes, k_header);
  if (little_endian(bytes, k_header + 4) != k_json_chunk || size < k_header + k_chunk_header ||
      length > size - k_header - k_chunk_header)
    fail(ErrorKind::asset, "{}: wanted a JSON chunk that ends in the file, found one of {} bytes",
         name, length);
  return bytes.substr(k_header + k_chunk_header, length);
}

/// What is nested deeper is no file that a program wrote, and would exhaust the stack of what reads it.
void refuse_deep(std::string_view json, const std::string& name) {
  constexpr int k_deepest = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > k_deepest)
        fail(ErrorKind::asset, "{}: its JSON is nested deeper than {}", name, k_deepest);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// "parse error at line 1, column 20: ...", without the library's number before it; of the file's own bytes
/// in it only what can be printed.
std::string told_by(const nlohmann::json::exception& error) {
  constexpr std::size_t k_most = 200;  // a damaged file may hold one endless word
  std::string text = error.what();
  if (const std::size_t at = text.find("] "); text.starts_with('[') && at != text.npos)
    text.erase(0, at + 2);
  if (text.size() > k_most) text.resize(k_most);
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

nlohmann::json parsed(std::string_view json, const std::string& name) {
  refuse_deep(json, name);
  nlohmann::json root;
  try {
    root = nlohmann::json::parse(json);
  } catch (const nlohmann::json::exception& error) {
    fail(ErrorKind::asset, "{}: its JSON cannot be read: {}", name, told_by(error));
  }
  if (!root.is_object()) fail(ErrorKind::asset, "{}: wanted a JSON object", name);
  return root;
}

/// Those that say nothing of a mesh's shape may be required and passed over.
bool may_be_required(std::string_view extension) {
  constexpr std::array<std::string_view, 5> k_passed_over{
      "KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "MSFT_texture_"};
  return extension == "KHR_mesh_quantization" ||
         std::any_of(k_passed_over.begin(), k_passed_over.end(),
                     [&](std::string_view p) { return extension.starts_with(p); });
}

void refuse_extensions(const nlohmann::json& root, const std::string& name) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end() || !required->is_array()) return;
  for (const nlohmann::json& extension : *required)
    if (extension.is_string() && !may_be_required(extension.get_ref<const std::string&>()))
      fail(ErrorKind::asset, "{}: it requires the glTF extension {}, which is not read", name,
           printable(extension.get_ref<const std::string&>()));
}

std::string percent_decoded(std::string_view uri) {
  const auto digit = [](char c) {
    constexpr std::string_view k_digits = "0123456789abcdef";
    return k_digits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c);
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) < 16 && digit(uri[i + 2]) < 16) {
      text += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

/// Where a uri leads, relative to the file that names it: never out of that file's folder.
fs::path checked(const std::string& uri, const std::string& name) {
  if (uri.starts_with("data:"))
    fail(ErrorKind::asset,
         "{}: wanted a data URI of base64 and of image/png, image/jpeg, image/bmp, image/gif or "
         "application/octet-stream, found {}",
         name, printable(std::string_view(uri).substr(5, uri.find(',') - 5)));
  const std::string decoded = percent_decoded(uri);
  fs::path path(decoded);
  const bool leaves =
      path.is_absolute() ||
      std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
  const bool odd = std::any_of(decoded.begin(), decoded.end(), [](char c) {
    return c == ':' || c == '\\' || static_cast<unsigned char>(c) < 32;
  });
  if (decoded.empty() || leaves || odd)
    fail(ErrorKind::asset, "{}: wanted a file beside it or below, found the uri \"{}\"", name,
         printable(std::string_view(uri).substr(0, 200)));
  return path;
}

}  // namespace

fs::path gltf_file_of_uri(const std::string& uri, const std::string& name) {
  return fs::path(name).parent_path() / checked(uri, name);
}

namespace {

struct BufferFile {
  fs::path file;
  std::string key;  ///< as tinygltf asks for it
  std::uint64_t bytes = 0;
  std::optional<std::string> data;  ///< of a data URI of a media type that tinygltf does not know
};

std::string base64_data(const std::string& uri, const std::string& name) {
  constexpr std::string_view k_mark = ";base64,";
  const std::size_t at = uri.find(k_mark);
  if (at == uri.npos)
    fail(ErrorKind::asset, "{}: wanted a data URI in base64, found \"{}\"", name,
         printable(std::string_view(uri).substr(0, 40)));
  return tinygltf::base64_decode(uri.substr(at + k_mark.size()));
}

std::vector<BufferFile> buffer_files(const nlohmann::json& root, const std::string& name) {
  std::vector<BufferFile> files;
  const auto buffers = root.find("buffers");
  if (buffers == root.end() || !buffers->is_array()) return files;
  for (const nlohmann::json& buffer : *buffers) {
    if (!buffer.is_object()) continue;
    const auto uri = buffer.find("uri");
    if (uri == buffer.end() || !uri->is_string()) continue;
    const std::string& text = uri->get_ref<const std::string&>();
    if (tinygltf::IsDataURI(text)) continue;
    const auto length = buffer.find("byteLength");
    BufferFile file;
    file.key = tinygltf::dlib::urldecode(text);
    if (length != buffer.end() && length->is_number_unsigned())
      file.bytes = length->get<std::uint64_t>();
    if (text.starts_with("data:"))
      file.data = base64_data(text, name);
    else
      file.file = gltf_file_of_uri(text, name);
    files.push_back(std::move(file));
  }
  return files;
}

using LoadedFiles = std::map<std::string, std::string>;

bool file_is_loaded(const std::string& path, void* files) {
  return static_cast<const LoadedFiles*>(files)->contains(path);
}
std::string same_path(const std::string& path, void*) {
  return path;
}
bool take_loaded(std::vector<unsigned char>* out, std::string*, const std::string& path,
                 void* files) {
  const std::string& bytes = static_cast<const LoadedFiles*>(files)->at(path);
  out->assign(bytes.begin(), bytes.end());
  return true;
}
/// Those of data URIs, as they are encoded; where others lie is known without this.
bool keep_image(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// Their first `bytes` bytes, where they have as many: what follows is padding.
LoadedFiles loaded(const std::vector<BufferFile>& files, const std::string& name) {
  LoadedFiles all;
  for (const BufferFile& file : files) {
    std::error_code error;
    if (!file.data && !fs::is_regular_file(file.file, error))
      fail(ErrorKind::asset, "{}: wanted the file of a buffer, {}, found none", name,
           printable(file.file.filename().string()));
    std::string bytes = file.data ? *file.data : read_text_file(file.file);
    if (bytes.size() < file.bytes)
      fail(ErrorKind::asset, "{}: cut off: {} promises {} bytes, found {}",
           file.data ? "a data URI" : file.file.string(), name, file.bytes, bytes.size());
    bytes.resize(file.bytes);
    all[file.key] = std::move(bytes);
  }
  return all;
}

/// The first line of what tinygltf says.
std::string first_line(const std::string& error) {
  const std::string line = error.substr(0, std::min(error.find('\n'), std::size_t{300}));
  return line.empty() ? "it cannot be read" : printable(line);
}

}  // namespace

bool is_gltf(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return is_binary(bytes) || (first != bytes.npos && bytes[first] == '{');
}

GltfFile load_gltf(std::string_view bytes, const std::string& name) {
  const std::string_view json = json_of(bytes, name);
  constexpr std::size_t k_most = 0x7fffffff;
  if (bytes.size() > k_most)
    fail(ErrorKind::asset, "{}: wanted a glTF file of at most {} bytes, found {}", name, k_most,
         bytes.size());
  LoadedFiles files;
  {
    const nlohmann::json root = parsed(json, name);
    refuse_extensions(root, name);
    files = loaded(buffer_files(root, name), name);
  }
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  loader.SetFsCallbacks({file_is_loaded, same_path, take_loaded, nullptr, &files});
  GltfFile result;
  std::string error, warning;
  bool read = false;
  try {
    read = is_binary(bytes)
               ? loader.LoadBinaryFromMemory(&result.model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(bytes.data()),
                                             static_cast<unsigned>(bytes.size()))
               : loader.LoadASCIIFromString(&result.model, &error, &warning, bytes.data(),
                                            static_cast<unsigned>(bytes.size()), "");
  } catch (const std::exception& thrown) {  // of the JSON library, for numbers of a wrong type
    error = thrown.what();
  }
  if (!read) fail(ErrorKind::asset, "{}: {}", name, first_line(error));
  if (!result.model.asset.version.starts_with("2."))
    fail(ErrorKind::asset, "{}: wanted glTF of version 2, found version {}", name,
         printable(result.model.asset.version));
  if (is_binary(bytes)) result.trailing_bytes = bytes.size() - little_endian(bytes, 8);
  return result;
}

std::vector<fs::path> gltf_buffer_files(std::string_view bytes, const std::string& name) {
  std::vector<fs::path> paths;
  for (const BufferFile& file : buffer_files(parsed(json_of(bytes, name), name), name))
    if (!file.data) paths.push_back(file.file);
  return paths;
}

}  // namespace ds
