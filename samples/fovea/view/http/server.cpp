#include "samples/fovea/view/http/server.h"

#include <civetweb.h>
#include <fmt/format.h>

#include <atomic>
#include <chrono>

#include "fovea/error.h"
#include "samples/fovea/view/exchange.h"
#include "samples/fovea/view/http/answers.h"
#include "samples/fovea/view/http/request.h"

namespace fovea::view {
namespace {

// Threads of the server; some are left for short requests while pages listen and wait.
constexpr int kThreads = 40, kListeners = 16;
constexpr std::chrono::milliseconds kPictureWait{8000}, kTickWait{500};
constexpr std::chrono::milliseconds kRetry{500};  // after which a page looks for a server that has gone

const char* headerOf(const mg_connection* connection, const char* name) {
  const char* value = mg_get_header(connection, name);
  return value ? value : "";
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

std::string readBody(mg_connection* connection, size_t length) {
  std::string body(length, '\0');
  size_t got = 0;
  while (got < length) {
    const int count = mg_read(connection, body.data() + got, length - got);
    if (count <= 0) break;
    got += size_t(count);
  }
  body.resize(got);
  return body;
}

int ignoreLog(const mg_connection*, const char*) { return 1; }  // vanished clients are not worth a line

}  // namespace

struct Server::Impl {
  Exchange& exchange;
  Answers answers;
  std::string address;
  uint16_t port = 0;
  mg_context* context = nullptr;
  std::atomic<int> listeners = 0;

  Impl(Exchange& e, Access access) : exchange(e), answers(e, std::move(access), kPictureWait) {}
  ~Impl() {
    if (context) mg_stop(context);
    mg_exit_library();
  }

  static int onRequest(mg_connection* connection);
  void events(mg_connection* connection);
};

int Server::Impl::onRequest(mg_connection* connection) {
  const mg_request_info& info = *mg_get_request_info(connection);
  auto& impl = *static_cast<Impl*>(info.user_data);
  const Request request{info.request_method ? info.request_method : "",
                        info.request_uri ? info.request_uri : "",
                        info.query_string ? info.query_string : "",
                        headerOf(connection, "Host"),
                        headerOf(connection, "Origin"),
                        headerOf(connection, "Sec-Fetch-Site"),
                        info.content_length};
  if (asksForEvents(request, impl.answers.access())) {
    impl.events(connection);
    return 200;
  }
  const Answer answer =
      impl.answers.answer(request, [&](size_t length) { return readBody(connection, length); });
  send(connection, answer);
  return answer.status;
}

// Server-sent events, until the page goes away.
void Server::Impl::events(mg_connection* connection) {
  const Place place(listeners, kListeners);
  if (!place) return send(connection, busy());
  const std::string head = fmt::format(
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nConnection: close\r\n{}\r\n"
      "retry: {}\n\n",
      kSafety, kRetry.count());
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
}

Server::Server(Exchange& exchange, const std::string& host, uint16_t port, const std::string& token)
    : impl_(std::make_unique<Impl>(exchange, Access{token, host})) {
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
  impl_->port = uint16_t(ports[0].port);
  impl_->address = fmt::format("http://{}:{}/{}/", literal, ports[0].port, impl_->answers.access().token);
}

Server::~Server() = default;

const std::string& Server::address() const { return impl_->address; }

uint16_t Server::port() const { return impl_->port; }

const std::string& Server::token() const { return impl_->answers.access().token; }

}  // namespace fovea::view
