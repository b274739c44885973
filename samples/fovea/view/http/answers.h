// The answers to pages, from an Exchange. Nothing here needs a socket, so that tests and fuzzers reach all of it; only
// the stream of events, which never ends, is the server's own.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/http/request.h"

namespace fovea::view {

struct Answer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8", body, headers = {};
};

// Counts up while it lives, unless there are too many already.
class Place {
 public:
  Place(std::atomic<int>& taken, int most) : taken_(taken), free_(++taken <= most) {}
  ~Place() { --taken_; }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  explicit operator bool() const { return free_; }

 private:
  std::atomic<int>& taken_;
  bool free_;
};
Answer busy();  // where there is no place

class Answers {
 public:
  // The body of a request, up to so many bytes; shorter if the client sends less.
  using ReadBody = std::function<std::string(size_t)>;

  // A picture is waited for no longer than `most`.
  Answers(Exchange& exchange, Access access, std::chrono::milliseconds most)
      : exchange_(exchange), access_(std::move(access)), wait_(most) {}
  // Refuses what check() refuses, and answers the rest. Throws nothing.
  Answer answer(const Request& request, const ReadBody& body);
  const Access& access() const { return access_; }

 private:
  Answer served(const Request& request, const std::string& name, const ReadBody& body);
  ShotPointer shotFor(std::string_view query, Answer& refusal);
  ShotPointer shotOf(const std::string& source, uint64_t after, Answer& refusal);
  // Pictures of one frame, for `source` and the one that the query calls `name`.
  std::pair<ShotPointer, ShotPointer> pairFor(std::string_view query, const char* name, Answer& refusal);
  Answer measures(std::string_view query);
  Answer picture(std::string_view query);
  Answer file(const std::string& name, std::string_view query);
  Answer pixels(std::string_view query);
  Answer numbersOf(std::string_view query);
  Answer command(const Request& request, const ReadBody& body);

  Exchange& exchange_;
  Access access_;
  std::chrono::milliseconds wait_;
  std::atomic<int> waiters_ = 0;
};

}  // namespace fovea::view
