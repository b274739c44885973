// Any bytes as a request to the viewer, and what must hold of its answer.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/graph.h"
#include "samples/fovea/view/http/answers.h"

namespace fovea::fuzz {

inline const view::Access kViewAccess{"0123456789abcdef0123456789abcdef", "render.example"};

inline void failView(const char* what, const view::Request& request) {
  std::fprintf(stderr, "%s: %s %s?%s\n", what, request.method.c_str(), request.target.c_str(),
               request.query.c_str());
  std::abort();
}

// A viewer without a run: sources "image", "mask", "ids" and "list" have pictures of 5x3 pixels, and a buffer.
class ViewServer {
 public:
  ViewServer() : answers_(exchange_, kViewAccess, std::chrono::milliseconds(0)) {
    exchange_.setState("{}");
    exchange_.setRecording("t,x,y,valid\n", "{}");
  }

  // Lines: method, target, query, host, origin, fetch site, announced length; the rest is the body.
  static std::pair<view::Request, std::string> parse(std::string_view text) {
    const auto line = [&] {
      const std::string_view found = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), found.size() + 1));
      return std::string(found);
    };
    view::Request r;
    r.method = line();
    r.target = line();
    r.query = line();
    r.host = line();
    r.origin = line();
    r.fetchSite = line();
    r.bodyBytes = std::atoll(line().c_str());
    return {r, std::string(text)};
  }

  // Aborts if the answer is not what it must be. Returns its status.
  int ask(const view::Request& request, const std::string& body) {
    if (asked_++ % kPublishEvery == 0) publish();
    const view::Answer answer =
        answers_.answer(request, [&](size_t length) { return body.substr(0, length); });
    exchange_.takeCommands();
    const view::Verdict verdict = view::check(request, kViewAccess);
    if (verdict.status != 200 && (answer.status != verdict.status || answer.body.size() > 100))
      failView("a refused request is answered", request);
    if (verdict.status == 200 && request.target.find(kViewAccess.token) == std::string::npos)
      failView("a request without the token is answered", request);
    if (answer.status == 503 && request.method != "POST") failView("an exception came through", request);
    checkHeaders(request, answer.headers);
    return answer.status;
  }

 private:
  // Whole lines, "Name: value", which no request can break.
  static void checkHeaders(const view::Request& request, std::string_view headers) {
    while (!headers.empty()) {
      const size_t end = headers.find("\r\n"), colon = headers.find(": ");
      const std::string_view line = headers.substr(0, end);
      if (end == std::string_view::npos || colon >= end ||
          line.find_first_of("\r\n") != std::string_view::npos)
        failView("a header is broken", request);
      headers.remove_prefix(end + 2);
    }
  }

  void publish() {
    constexpr uint32_t kWidth = 5, kHeight = 3;
    const auto show = [&](const char* source, VkFormat format, uint32_t bytesPerTexel) {
      exchange_.shot(source, 0, std::chrono::milliseconds(0));
      view::Shot shot;
      shot.metadata = std::make_shared<const image::Metadata>();
      graph::ResourceDesc& desc = shot.data.desc;
      desc.kind = format == VK_FORMAT_UNDEFINED ? graph::ResourceKind::Buffer : graph::ResourceKind::Image;
      desc.format = format;
      desc.width = kWidth;
      desc.height = kHeight;
      desc.stride = bytesPerTexel;
      desc.count = kWidth * kHeight;
      shot.data.bytes.resize(size_t(kWidth) * kHeight * bytesPerTexel);
      for (size_t i = 0; i < shot.data.bytes.size(); ++i) shot.data.bytes[i] = std::byte(i * 37 % 251);
      exchange_.publish(source, std::move(shot));
    };
    show("image", VK_FORMAT_R8G8B8A8_UNORM, 4);
    show("radiance", VK_FORMAT_R32G32B32A32_SFLOAT, 16);
    show("ids", VK_FORMAT_R32_UINT, 4);
    show("list", VK_FORMAT_UNDEFINED, 12);
  }

  static constexpr uint64_t kPublishEvery = 16;  // other sources that are asked for displace these
  uint64_t asked_ = 0;
  view::Exchange exchange_;
  view::Answers answers_;
};

}  // namespace fovea::fuzz
