#include "samples/fovea/view/http/server.h"

#include <civetweb.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>

#include "fovea/error.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/graph/describe.h"
#include "samples/fovea/view/http/page.h"
#include "samples/fovea/view/http/request.h"
#include "samples/fovea/view/picture/compare.h"
#include "samples/fovea/view/picture/display.h"
#include "samples/fovea/view/picture/export.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

// Threads of the server; some are left for short requests while pages listen and wait.
constexpr int kThreads = 40, kListeners = 16, kWaiters = 16;
constexpr std::chrono::milliseconds kPictureWait{8000}, kTickWait{500};

const char* headerOf(const mg_connection* connection, const char* name) {
  const char* value = mg_get_header(connection, name);
  return value ? value : "";
}

std::string_view mediaType(std::string_view file) {
  if (file.ends_with(".html")) return "text/html; charset=utf-8";
  if (file.ends_with(".css")) return "text/css; charset=utf-8";
  if (file.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (file.ends_with(".svg")) return "image/svg+xml";
  return "text/plain; charset=utf-8";
}

std::string_view statusText(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 411:
      return "Length Required";
    case 413:
      return "Content Too Large";
    default:
      return "Service Unavailable";
  }
}

// Nothing from elsewhere, nothing embedded elsewhere, nothing kept.
constexpr std::string_view kSafety =
    "Cache-Control: no-store\r\n"
    "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:; frame-ancestors 'none'; "
    "base-uri "
    "'none'; form-action 'none'\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "X-Content-Type-Options: nosniff\r\n";

struct Answer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8", body, headers = {};
};

void send(mg_connection* connection, const Answer& answer) {
  // Without reading what a refused request still sends, the connection is of no further use.
  const bool close = answer.status >= 400;
  const std::string head =
      fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {}\r\n{}{}\r\n",
                  answer.status, statusText(answer.status), answer.type, answer.body.size(),
                  close ? "close" : "keep-alive", kSafety, answer.headers);
  if (mg_write(connection, head.data(), head.size()) > 0 && !answer.body.empty())
    mg_write(connection, answer.body.data(), answer.body.size());
}

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

Answer busy() { return {503, "text/plain; charset=utf-8", "too many requests at once"}; }

int ignoreLog(const mg_connection*, const char*) { return 1; }  // vanished clients are not worth a line

nlohmann::json messagesJson(const Error& error) {
  nlohmann::json list = nlohmann::json::array();
  for (const Diagnostic& d : error.diagnostics())
    list.push_back({{"message", d.message}, {"path", d.path}, {"remedy", d.remedy}});
  return {{"messages", list}};
}

}  // namespace

struct Server::Impl {
  Exchange& exchange;
  Access access;
  std::string address;
  mg_context* context = nullptr;
  std::atomic<int> listeners = 0, waiters = 0;

  explicit Impl(Exchange& e) : exchange(e) {}
  ~Impl() {
    if (context) mg_stop(context);
    mg_exit_library();
  }

  static int onRequest(mg_connection* connection);
  int handle(mg_connection* connection);
  Answer answer(mg_connection* connection, const std::string& method, const std::string& name,
                std::string_view query);
  ShotPointer shotFor(std::string_view query, Answer& refusal);
  ShotPointer shotOf(const std::string& source, uint64_t after, Answer& refusal);
  // Pictures of one frame, for `source` and the one that the query calls `name`.
  std::pair<ShotPointer, ShotPointer> pairFor(std::string_view query, const char* name, Answer& refusal);
  Answer measures(std::string_view query);
  Answer picture(std::string_view query);
  Answer file(const std::string& name, std::string_view query);
  Answer pixels(std::string_view query);
  Answer numbersOf(std::string_view query);
  Answer command(mg_connection* connection);
  Answer events(mg_connection* connection);
};

int Server::Impl::onRequest(mg_connection* connection) {
  auto* impl = static_cast<Impl*>(mg_get_request_info(connection)->user_data);
  try {
    return impl->handle(connection);
  } catch (const Error& e) {
    send(connection, {404, "text/plain; charset=utf-8", e.what()});
    return 404;
  } catch (const std::exception& e) {
    send(connection, {503, "text/plain; charset=utf-8", e.what()});
    return 503;
  }
}

int Server::Impl::handle(mg_connection* connection) {
  const mg_request_info& info = *mg_get_request_info(connection);
  const Request request{info.request_method ? info.request_method : "",
                        info.request_uri ? info.request_uri : "",
                        headerOf(connection, "Host"),
                        headerOf(connection, "Origin"),
                        headerOf(connection, "Sec-Fetch-Site"),
                        info.content_length};
  const Verdict verdict = check(request, access);
  if (verdict.status != 200) {
    send(connection, {verdict.status, "text/plain; charset=utf-8", verdict.reason + "\n"});
    return verdict.status;
  }
  const Answer result =
      answer(connection, request.method, verdict.name, info.query_string ? info.query_string : "");
  if (result.status > 0) send(connection, result);
  return result.status > 0 ? result.status : 200;
}

Answer Server::Impl::answer(mg_connection* connection, const std::string& method, const std::string& name,
                            std::string_view query) {
  if (method == "POST")
    return name == "control" ? command(connection) : Answer{404, "text/plain", "not found\n"};
  if (name == "picture") return picture(query);
  if (name == "picture.png" || name == "picture.exr") return file(name, query);
  if (name == "pixels") return pixels(query);
  if (name == "statistics") return numbersOf(query);
  if (name == "measures") return measures(query);
  if (name == "state") return {200, "application/json", exchange.state()};
  if (name == "events") return events(connection);
  if (name == "gaze.csv")
    return {200, "text/csv", exchange.gazeTable(),
            "Content-Disposition: attachment; filename=\"gaze.csv\"\r\n"};
  if (name == "camera.json")
    return {200, "application/json", exchange.cameraKeys(),
            "Content-Disposition: attachment; filename=\"camera.json\"\r\n"};
  for (const PageFile& file : pageFiles())
    if (file.name == (name.empty() ? "index.html" : name))
      return {200, std::string(mediaType(file.name)), std::string(file.text)};
  return {404, "text/plain", "not found\n"};
}

// nullptr if there is no picture, with the answer that says so.
ShotPointer Server::Impl::shotOf(const std::string& source, uint64_t after, Answer& refusal) {
  if (source.empty() || source.size() > 256) {
    refusal = {400, "text/plain; charset=utf-8", "name a source"};
    return nullptr;
  }
  const Place place(waiters, kWaiters);
  if (!place) {
    refusal = busy();
    return nullptr;
  }
  ShotPointer shot = exchange.shot(source, after, kPictureWait);
  if (!shot || shot->absent) {
    refusal = {204, "text/plain", {}};  // ask again
    return nullptr;
  }
  if (!shot->refusal.empty()) {
    refusal = {404, "text/plain; charset=utf-8", shot->refusal};
    return nullptr;
  }
  return shot;
}

ShotPointer Server::Impl::shotFor(std::string_view query, Answer& refusal) {
  return shotOf(queryValue(query, "source").value_or(""), uint64_t(queryNumber(query, "after", 0, 9e15, 0)),
                refusal);
}

std::pair<ShotPointer, ShotPointer> Server::Impl::pairFor(std::string_view query, const char* name,
                                                          Answer& refusal) {
  constexpr int kTries = 4;
  const std::string source = queryValue(query, "source").value_or(""),
                    other = queryValue(query, name).value_or("");
  auto after = uint64_t(queryNumber(query, "after", 0, 9e15, 0));
  uint64_t otherAfter = 0;
  for (int i = 0; i < kTries; ++i) {
    ShotPointer a = shotOf(source, after, refusal);
    ShotPointer b = a ? shotOf(other, otherAfter, refusal) : nullptr;
    if (!b) return {};
    if (a->frame == b->frame) return {std::move(a), std::move(b)};
    // Whichever is behind is taken anew.
    if (a->frame < b->frame) after = a->number;
    if (b->frame < a->frame) otherAfter = b->number;
  }
  refusal = {204, "text/plain", {}};
  return {};
}

namespace {

std::string shotHeaders(const Shot& shot) {
  const Layout layout = layoutOf(shot.data.desc);
  constexpr const char* kTypes[] = {"float32", "uint32", "int32"};
  return fmt::format(
      "X-Fovea-Number: {}\r\nX-Fovea-Frame: {}\r\nX-Fovea-Size: {}x{}\r\nX-Fovea-Channels: {}\r\n"
      "X-Fovea-Type: {}\r\nX-Fovea-Encoded: {}\r\nX-Fovea-Frames: {}\r\n",
      shot.number, shot.frame, layout.width, layout.height, layout.channels, kTypes[int(layout.type)],
      layout.encoded ? 1 : 0, shot.frames);
}

}  // namespace

Answer Server::Impl::picture(std::string_view query) {
  Answer refusal;
  if (queryValue(query, "minus")) {
    const auto [a, b] = pairFor(query, "minus", refusal);
    if (!a || !b) return refusal;
    const Display display = parseDisplay(query);
    return {200, "image/jpeg", jpeg(draw(difference(a->data, b->data), display), display.quality),
            shotHeaders(*a)};
  }
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  if (shot->data.desc.kind == graph::ResourceKind::Buffer)
    return {200, "application/octet-stream", {}, shotHeaders(*shot)};
  const Display display = parseDisplay(query);
  return {200, "image/jpeg", jpeg(draw(shot->data, display), display.quality), shotHeaders(*shot)};
}

Answer Server::Impl::file(const std::string& name, std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  std::string source = queryValue(query, "source").value_or("");
  std::replace_if(
      source.begin(), source.end(),
      [](char c) { return !std::isalnum(static_cast<unsigned char>(c)) && c != '.'; }, '_');
  const bool exr = name.ends_with(".exr");
  return {200, exr ? "image/x-exr" : "image/png",
          exr ? exrFile(*shot, source) : pngFile(*shot, parseDisplay(query)),
          fmt::format("Content-Disposition: attachment; filename=\"{}_{:04}.{}\"\r\n", source, shot->frame,
                      exr ? "exr" : "png")};
}

namespace {

// The region that a query names; what it leaves out is that of `otherwise`. nullopt if it begins outside.
std::optional<Region> regionOf(std::string_view query, const Layout& layout, const Region& otherwise) {
  constexpr double kMost = 1e9;
  const auto read = [&](const char* name, double low, uint32_t value) {
    return uint32_t(queryNumber(query, name, low, kMost, value));
  };
  Region region{read("x", 0, otherwise.x), read("y", 0, otherwise.y), read("width", 1, otherwise.width),
                read("height", 1, otherwise.height)};
  if (region.x >= layout.width || region.y >= layout.height) return std::nullopt;
  region.width = std::min(region.width, layout.width - region.x);
  region.height = std::min(region.height, layout.height - region.y);
  return region;
}

Answer outside() { return {404, "text/plain", "outside of the picture\n"}; }

}  // namespace

Answer Server::Impl::pixels(std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  const std::optional<Region> region = regionOf(query, layoutOf(shot->data.desc), {0, 0, 1, 1});
  if (!region) return outside();
  const std::vector<uint32_t> all = words(shot->data, *region);
  return {200, "application/octet-stream",
          std::string(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(uint32_t)),
          shotHeaders(*shot) + fmt::format("X-Fovea-Region: {}x{}\r\n", region->width, region->height)};
}

Answer Server::Impl::numbersOf(std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  const Layout layout = layoutOf(shot->data.desc);
  const std::optional<Region> region = regionOf(query, layout, wholeOf(layout));
  if (!region) return outside();
  nlohmann::json channels = nlohmann::json::array();
  for (const ChannelStatistics& c : statistics(shot->data, *region))
    channels.push_back({{"min", c.min},
                        {"max", c.max},
                        {"mean", c.mean},
                        {"nan", c.nan},
                        {"infinite", c.infinite},
                        {"histogram", c.histogram}});
  return {200, "application/json", textOf({{"channels", channels}, {"frame", shot->frame}}),
          shotHeaders(*shot)};
}

Answer Server::Impl::measures(std::string_view query) {
  Answer refusal;
  const auto [picture, reference] = pairFor(query, "reference", refusal);
  if (!picture || !reference) return refusal;
  const auto regions =
      measure(picture->data, reference->data, picture->exposure, picture->gaze, picture->foveaRadius);
  const auto json = [](const image::Measures& m) {  // NaN and infinity become null
    return nlohmann::json{
        {"pixels", m.pixels}, {"mse", m.mse}, {"psnr", m.psnr}, {"rel_mse", m.relMse}, {"flip", m.flip}};
  };
  return {200, "application/json",
          textOf({{"fovea", json(regions.fovea)},
                  {"periphery", json(regions.periphery)},
                  {"whole", json(regions.whole)},
                  {"frame", picture->frame},
                  {"frames", reference->frames}})};
}

Answer Server::Impl::command(mg_connection* connection) {
  const int64_t length = mg_get_request_info(connection)->content_length;
  std::string body(size_t(std::clamp<int64_t>(length, 0, int64_t(kMaxBody))), '\0');
  size_t got = 0;
  while (got < body.size()) {
    const int count = mg_read(connection, body.data() + got, body.size() - got);
    if (count <= 0) return {400, "text/plain", "the body is shorter than announced\n"};
    got += size_t(count);
  }
  try {
    return exchange.send(parseCommand(body)) ? Answer{204, "text/plain", {}} : busy();
  } catch (const Error& error) {
    return {400, "application/json", textOf(messagesJson(error))};
  }
}

// Server-sent events, until the page goes away. A status of 0 says that the answer has been sent.
Answer Server::Impl::events(mg_connection* connection) {
  const Place place(listeners, kListeners);
  if (!place) return busy();
  const std::string head = fmt::format(
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n{}\r\n", kSafety);
  bool there = mg_write(connection, head.data(), head.size()) > 0;
  exchange.addWatcher(1);
  uint64_t number = 0;
  while (there && !exchange.stopped()) {
    const std::optional<Exchange::Tick> tick = exchange.tick(number, kTickWait);
    if (tick) number = tick->number;
    // The comment finds out whether the page is still there.
    const std::string text = tick ? "data: " + tick->json + "\n\n" : std::string(": \n\n");
    there = mg_write(connection, text.data(), text.size()) > 0;
  }
  exchange.addWatcher(-1);
  return {0};
}

Server::Server(Exchange& exchange, const std::string& host, uint16_t port)
    : impl_(std::make_unique<Impl>(exchange)) {
  impl_->access = {makeToken(), host};
  mg_init_library(0);
  const std::string literal = host.find(':') != std::string::npos ? "[" + host + "]" : host;
  const std::string listen = fmt::format("{}:{}", literal == "localhost" ? "127.0.0.1" : literal, port),
                    threads = std::to_string(kThreads);
  const char* options[] = {"listening_ports",
                           listen.c_str(),
                           "num_threads",
                           threads.c_str(),
                           "request_timeout_ms",
                           "10000",
                           "tcp_nodelay",
                           "1",
                           "enable_keep_alive",
                           "yes",
                           "keep_alive_timeout_ms",
                           "5000",
                           nullptr};
  mg_callbacks callbacks{};
  callbacks.begin_request = Impl::onRequest;
  callbacks.log_message = ignoreLog;
  impl_->context = mg_start(&callbacks, impl_.get(), options);
  mg_server_port ports[1] = {};
  if (!impl_->context || mg_get_server_ports(impl_->context, 1, ports) < 1)
    throw Error(ExitCode::Usage, fmt::format("cannot listen on {}", listen),
                "take another --port (0 for any free one), or a --host that is an address of this machine");
  impl_->address = fmt::format("http://{}:{}/{}/", literal, ports[0].port, impl_->access.token);
}

Server::~Server() = default;

const std::string& Server::address() const { return impl_->address; }

}  // namespace fovea::view
