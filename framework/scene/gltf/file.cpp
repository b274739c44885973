// Reads a .gltf or .glb file and the files beside it, and nothing else.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "framework/base/files.h"
#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace fs = std::filesystem;
namespace {

uint32_t readU32(const std::vector<uint8_t>& bytes, size_t offset) {
  return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
         uint32_t(bytes[offset + 3]) << 24;
}

[[noreturn]] void badGlb(const Source& s, const std::string& what) {
  throw Error(ExitCode::BadInput, s.name + ": " + what,
              "the file is damaged or cut short; export or download it again");
}

// GLB container, glTF 2.0 section 4: a 12-byte header, the JSON chunk, then at most one BIN chunk that is used.
void splitGlb(Source& s) {
  const std::vector<uint8_t>& b = s.bytes;
  if (b.size() < 12) badGlb(s, "a GLB header has 12 bytes, the file only " + std::to_string(b.size()));
  const uint32_t version = readU32(b, 4);
  if (version != 2)
    throw Error(ExitCode::BadInput,
                s.name + ": GLB version " + std::to_string(version) + "; only version 2 can be read",
                "convert the model to glTF 2.0");
  const uint64_t length = readU32(b, 8);
  if (length > b.size())
    badGlb(s, "the GLB header promises " + std::to_string(length) + " bytes, the file has " +
                  std::to_string(b.size()));
  if (length < 20)
    badGlb(s, "the GLB header gives a length of " + std::to_string(length) + " bytes; no JSON chunk fits");
  const uint64_t jsonLength = readU32(b, 12);
  if (std::memcmp(&b[16], "JSON", 4) != 0) badGlb(s, "the first GLB chunk is not JSON");
  if (jsonLength == 0 || 20 + jsonLength > length)
    badGlb(s, "the JSON chunk claims " + std::to_string(jsonLength) + " bytes, the file holds " +
                  std::to_string(length - 20) + " after its header");
  s.json = std::string_view(reinterpret_cast<const char*>(&b[20]), size_t(jsonLength));
  while (!s.json.empty() && s.json.back() == '\0')
    s.json.remove_suffix(1);  // some exporters pad with NUL, not spaces
  const uint64_t next = 20 + jsonLength;
  if (next == length) return;
  if (next + 8 > length) badGlb(s, "the GLB file ends inside the header of its second chunk");
  const uint64_t binLength = readU32(b, size_t(next));
  if (next + 8 + binLength > length)
    badGlb(s, "the BIN chunk claims " + std::to_string(binLength) + " bytes, the file holds " +
                  std::to_string(length - next - 8));
  if (std::memcmp(&b[size_t(next) + 4], "BIN\0", 4) == 0)
    s.chunk = std::span(b).subspan(size_t(next) + 8, size_t(binLength));
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percentDecode(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0) {
      out += char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2]));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

// -1 for what is none; also of the alphabet for file names (RFC 4648, 5).
int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

// Matches "http:", "file:", and the "c:" of a Windows path.
bool hasScheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.substr(0, colon).find('/') == std::string_view::npos;
}

}  // namespace

std::vector<uint8_t> readFile(const fs::path& file) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  if (!fs::exists(status)) throw Error(ExitCode::BadInput, file.string() + ": there is no such file");
  // Devices and pipes may never end, and folders read as empty.
  if (!fs::is_regular_file(status))
    throw Error(ExitCode::BadInput, file.string() + ": is not a regular file");
  const uint64_t size = fs::file_size(file, ec);
  if (ec) throw Error(ExitCode::BadInput, file.string() + ": " + ec.message());
  if (size > kMaxFileBytes)
    throw Error(ExitCode::BadInput,
                file.string() + ": " + std::to_string(size) + " bytes; models and their parts may have " +
                    std::to_string(kMaxFileBytes) + " each",
                "split the model's buffer");
  std::ifstream in(file, std::ios::binary);
  noteRead(file);
  std::vector<uint8_t> bytes(size);
  if (!in || (size > 0 && !in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))))
    throw Error(ExitCode::BadInput, file.string() + ": cannot be read", "check its permissions");
  return bytes;
}

Source sourceOf(std::vector<uint8_t> bytes, const fs::path& file) {
  Source s;
  s.file = file;
  s.name = file.string();
  s.bytes = std::move(bytes);
  std::error_code ec;
  s.folder = fs::absolute(file, ec).lexically_normal().parent_path();
  if (s.bytes.empty()) throw Error(ExitCode::BadInput, s.name + ": the file is empty");
  s.binary = s.bytes.size() >= 4 && std::memcmp(s.bytes.data(), "glTF", 4) == 0;
  if (s.binary)
    splitGlb(s);
  else
    s.json = std::string_view(reinterpret_cast<const char*>(s.bytes.data()), s.bytes.size());
  return s;
}

static bool sameLetters(std::string_view text, std::string_view lower) {
  return std::ranges::equal(text, lower, {}, [](unsigned char c) { return char(std::tolower(c)); });
}

bool isDataUri(std::string_view uri) { return sameLetters(uri.substr(0, 5), "data:"); }

std::optional<std::string_view> dataOf(std::string_view uri) {
  constexpr std::string_view kMark = ";base64";
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos || comma < 5 + kMark.size() || comma + 1 == uri.size())
    return std::nullopt;
  if (!sameLetters(uri.substr(comma - kMark.size(), kMark.size()), kMark)) return std::nullopt;
  return uri.substr(comma + 1);
}

DataUri decodeDataUri(std::string_view uri) {
  const std::optional<std::string_view> written = dataOf(uri);
  if (!written) return {{}, "the data uri has no data that can be read"};
  const std::string decoded = written->find('%') == std::string_view::npos ? "" : percentDecode(*written);
  const std::string_view text = decoded.empty() ? *written : std::string_view(decoded);
  DataUri out;
  out.bytes.reserve(text.size() / 4 * 3 + 3);
  uint32_t bits = 0;
  int count = 0;
  for (size_t i = 0; i < text.size() && text[i] != '='; ++i) {
    if (std::isspace(static_cast<unsigned char>(text[i]))) continue;
    const int digit = base64Digit(text[i]);
    if (digit < 0) return {{}, "character " + std::to_string(i + 1) + " of the data is not base64"};
    bits = bits << 6 | uint32_t(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.bytes.push_back(uint8_t(bits >> count));
  }
  return out;
}

// Links could lead out of the folder, too. The place of the model itself counts as well: collections of links to models
// and their parts are common.
static bool staysInside(const Source& source, const fs::path& file) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(file, ignored);
  for (const fs::path& root : {source.folder, fs::weakly_canonical(source.file, ignored).parent_path()}) {
    const fs::path inside = real.lexically_relative(fs::weakly_canonical(root, ignored));
    if (!inside.empty() && *inside.begin() != "..") return true;
  }
  return false;
}

// Whoever sets this trusts the links that they have made, or that git-annex, DVC or Nix have.
static bool followsLinks() {
  const char* variable = std::getenv("FOVEA_FOLLOW_LINKS");
  const std::string_view value = variable ? variable : "";
  if (!value.empty() && value != "0" && value != "1")
    throw Error(ExitCode::BadInput, "FOVEA_FOLLOW_LINKS is `" + std::string(value) + "`, neither 0 nor 1",
                "unset it, or set it to 1");
  return value == "1";
}

ResolvedUri resolveUri(const Source& source, std::string_view uri) {
  ResolvedUri r;
  r.remedy = "put the file into the model's folder and name it relative to that";
  r.decoded = percentDecode(uri);
  const std::string& text = r.decoded;
  const fs::path relative = fs::path(text).lexically_normal();
  if (text.empty()) {
    r.problem = "an empty uri names no file";
  } else if (text.find('\0') != std::string::npos) {
    r.problem = "a uri cannot hold a NUL";
  } else if (hasScheme(text)) {
    r.problem = "only data: uris and files beside the model can be read";
  } else if (text[0] == '/' || text[0] == '\\' || relative.is_absolute()) {
    r.problem = "absolute paths are refused";
  } else if (!relative.empty() && *relative.begin() == "..") {
    r.problem = "it leads out of the model's folder, which is refused";
  } else if (!relative.has_filename() || relative == ".") {
    r.problem = "it names a folder, not a file";
  } else {
    r.file = source.folder / relative;
    std::error_code ignored;
    if (text.find('\\') != std::string::npos && !fs::exists(r.file, ignored)) {
      std::string slashes = text;
      std::replace(slashes.begin(), slashes.end(), '\\', '/');
      r.problem = "there is no file of this name; in a uri, slashes and not backslashes separate folders";
      r.remedy = "write \"" + slashes + "\"";
    } else if (!staysInside(source, r.file) && !followsLinks()) {
      r.problem = "it is a link that leads out of the model's folder, which is refused";
      r.remedy =
          "if the links of this model can be trusted, follow them: --follow-links, or FOVEA_FOLLOW_LINKS=1 "
          "in the "
          "environment";
    }
  }
  return r;
}

std::string whyMissing(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_symlink(file, ignored)) return "the file " + file.string() + " is missing";
  return "the file " + file.string() + " is a link to " + fs::read_symlink(file, ignored).string() +
         ", which is missing";
}

}  // namespace fovea::scene::gltf
