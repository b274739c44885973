// Answers pages over HTTP, on threads of its own (civetweb). It serves the page, pictures, numbers and messages out of
// an Exchange and passes commands on to it; it reads no file and knows no device.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace fovea::view {

class Exchange;

class Server {
 public:
  // `host` is a name or address of this machine, port 0 any free port, token what makeToken() gives. Throws
  // Error(Usage) if it cannot listen there. The exchange must outlive the server.
  Server(Exchange& exchange, const std::string& host, uint16_t port, const std::string& token);
  ~Server();                           // Exchange::stop() must have been called, so that nobody waits
  const std::string& address() const;  // "http://127.0.0.1:8042/TOKEN/"
  uint16_t port() const;
  const std::string& token() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fovea::view
