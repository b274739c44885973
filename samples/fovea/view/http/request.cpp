#include "samples/fovea/view/http/request.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "fovea/error.h"

namespace fovea::view {
namespace {

constexpr size_t kMaxTarget = 256, kMaxHost = 256;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// The comparison takes the same time wherever the texts differ.
bool sameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (size_t i = 0; i < a.size(); ++i) different |= unsigned(a[i] ^ b[i]);
  return different == 0;
}

// "name:80" and "[::1]:80" without their port; nullopt if this is no host.
std::optional<std::string> hostWithoutPort(std::string_view host) {
  if (host.empty() || host.size() > kMaxHost) return std::nullopt;
  const size_t end = host[0] == '[' ? host.find(']') : host.find(':');
  if (host[0] == '[' && end == std::string_view::npos) return std::nullopt;
  const size_t stop = host[0] == '[' ? end + 1 : std::min(end, host.size());
  const std::string_view port = host.substr(stop);
  if (!port.empty() && (port[0] != ':' || port.size() < 2 || port.size() > 6 ||
                        !std::all_of(port.begin() + 1, port.end(), isDigit)))
    return std::nullopt;
  std::string name(host.substr(0, stop));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return name;
}

bool isAddress(std::string_view name) {
  if (name.starts_with("[")) {
    return name.size() > 3 && std::all_of(name.begin() + 1, name.end() - 1, [](char c) {
             return std::isxdigit(static_cast<unsigned char>(c)) || c == ':' || c == '.';
           });
  }
  return std::count(name.begin(), name.end(), '.') == 3 &&
         std::all_of(name.begin(), name.end(), [](char c) { return isDigit(c) || c == '.'; });
}

bool knownHost(std::string_view host, const Access& access) {
  const std::optional<std::string> name = hostWithoutPort(host);
  return name && (*name == "localhost" || *name == access.hostName || isAddress(*name));
}

// Names that lead nowhere else: letters, digits, '_', '-' and dots between them.
bool plainName(std::string_view name) {
  if (name.starts_with(".") || name.find("..") != std::string_view::npos) return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  });
}

int hexDigit(char c) {
  if (isDigit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> decoded(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hexDigit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0 || high + low == 0) return std::nullopt;
    out += char(high * 16 + low);
    i += 2;
  }
  return out;
}

}  // namespace

Verdict check(const Request& request, const Access& access) {
  const std::string_view target = request.target;
  const size_t slash = target.find('/', 1);
  const bool known = target.size() <= kMaxTarget && target.starts_with("/") &&
                     slash != std::string_view::npos && sameSecret(target.substr(1, slash - 1), access.token);
  if (!known) return {404, {}, "not found; open the address that the program printed"};
  if (!knownHost(request.host, access)) return {403, {}, "this server does not answer to that host name"};
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return {403, {}, "requests from other sites are refused"};
  if (request.fetchSite == "cross-site" || request.fetchSite == "same-site")
    return {403, {}, "requests from other sites are refused"};
  if (request.method != "GET" && request.method != "POST") return {405, {}, "use GET or POST"};
  if (request.method == "POST" && request.bodyBytes < 0)
    return {411, {}, "the length of the body is missing"};
  if (request.bodyBytes > int64_t(kMaxBody)) return {413, {}, "the body is longer than 64 KiB"};
  const std::string_view name = target.substr(slash + 1);
  if (!plainName(name)) return {404, {}, "not found"};
  return {200, std::string(name), {}};
}

bool asksForEvents(const Request& request, const Access& access) {
  const Verdict verdict = check(request, access);
  return verdict.status == 200 && verdict.name == "events" && request.method == "GET";
}

std::string makeToken() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
    throw Error(ExitCode::Internal, "the system gave no random numbers for the viewer's address");
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

std::optional<std::string> queryValue(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view item = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), item.size() + 1));
    const size_t equals = item.find('=');
    if (equals != std::string_view::npos && item.substr(0, equals) == name)
      return decoded(item.substr(equals + 1));
  }
  return std::nullopt;
}

double queryNumber(std::string_view query, std::string_view name, double low, double high, double otherwise) {
  const std::optional<std::string> text = queryValue(query, name);
  if (!text) return otherwise;
  double value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || end != text->data() + text->size() || !std::isfinite(value)) return otherwise;
  return value >= low && value <= high ? value : otherwise;
}

}  // namespace fovea::view
