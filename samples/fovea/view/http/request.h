// Checks of the requests that a browser sends, before anything is served. Nothing here needs a socket, so that tests
// and fuzzers can reach all of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fovea::view {

inline constexpr size_t kMaxBody = size_t(64) << 10;  // bytes of a request's body

// The parts of a request that decide about it. Headers that were not sent are empty.
struct Request {
  std::string method, target,
      query;  // "/TOKEN/picture", and "source=image" of what follows the question mark
  std::string host, origin, fetchSite;
  int64_t bodyBytes = 0;  // -1 if the request does not say
};

// What a request has to know.
struct Access {
  std::string token;
  std::string hostName;  // the name or address that the server was bound to
};

struct Verdict {
  int status = 200;    // of HTTP; 200 if the request may be answered
  std::string name;    // what it asks for: the target without the token, "" for the page itself
  std::string reason;  // for the sender of a request that is refused
};

// Refuses a wrong token (404, as if nothing were there), a Host that is neither an IP address, `localhost` nor
// Access::hostName (403; a page of another site that points its own name here cannot read anything), an Origin other
// than the server's own (403), other methods than GET and POST (405), a POST without a length (411), a body that is too
// long (413), and a target with anything but plain names (404).
Verdict check(const Request& request, const Access& access);

// Whether a request that may be answered wants the stream of events.
bool asksForEvents(const Request& request, const Access& access);

// 32 hexadecimal digits from the random numbers of the system.
std::string makeToken();

// The value of a parameter in "a=1&b=two%20words"; nullopt if it is not there or not encoded correctly.
std::optional<std::string> queryValue(std::string_view query, std::string_view name);
// The same as a number; `otherwise` if it is absent, no number, not finite, or outside of [low, high].
double queryNumber(std::string_view query, std::string_view name, double low, double high, double otherwise);

}  // namespace fovea::view
