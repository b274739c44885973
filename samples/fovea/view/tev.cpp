#include "samples/fovea/view/tev.h"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <utility>

#include "fovea/error.h"
#include "fovea/image.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

using std::chrono::milliseconds;

// Types of packets (IpcPacket::EType of tev); the update is the one with offsets and strides, version 3.
constexpr char kCreateImage = 4, kUpdateImage = 6;
constexpr milliseconds kShotWait{300}, kRetry{500};
constexpr int kConnectWait = 1000, kSendWait = 2000;  // milliseconds

// Numbers in the order of bytes of the machines that both programs run on.
class Packet {
 public:
  explicit Packet(char type) {
    add(uint32_t(0));  // the length of the whole, set at the end
    add(type);
    add(char(0));  // does not take the focus
  }
  template <class T>
  void add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  void add(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) add(text);
  }
  void add(const std::vector<float>& values) {
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  }
  std::string finished() && {
    const auto length = uint32_t(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

// Closes itself.
class Socket {
 public:
  explicit Socket(int number) : number_(number) {}
  ~Socket() {
    if (number_ >= 0) close(number_);
  }
  Socket(Socket&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

bool ready(int socket, int most) {
  pollfd wanted{socket, POLLOUT, 0};
  return poll(&wanted, 1, most) == 1 && (wanted.revents & POLLOUT) != 0;
}

Socket connectTo(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return Socket(-1);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  for (const addrinfo* at = found; at; at = at->ai_next) {
    Socket made(socket(at->ai_family, at->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, at->ai_protocol));
    if (!made) continue;
    int error = connect(made.number(), at->ai_addr, at->ai_addrlen) == 0 ? 0 : errno;
    socklen_t size = sizeof error;
    if (error == EINPROGRESS && ready(made.number(), kConnectWait))
      getsockopt(made.number(), SOL_SOCKET, SO_ERROR, &error, &size);
    if (error == 0) return made;
  }
  return Socket(-1);
}

bool sendAll(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    if (!ready(socket, kSendWait)) return false;
    const ssize_t sent = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(size_t(sent));
  }
  return true;
}

// tev sends nothing, so what can be read is the end of the connection.
bool closedByPeer(int socket) {
  char byte;
  return recv(socket, &byte, 1, MSG_DONTWAIT) == 0;
}

}  // namespace

std::string tevCreatePacket(const TevImage& image) {
  Packet packet(kCreateImage);
  packet.add(image.name);
  packet.add(int32_t(image.width));
  packet.add(int32_t(image.height));
  packet.add(int32_t(image.channels.size()));
  packet.add(image.channels);
  return std::move(packet).finished();
}

std::string tevUpdatePacket(const TevImage& image) {
  const auto channels = int32_t(image.channels.size());
  Packet packet(kUpdateImage);
  packet.add(image.name);
  packet.add(channels);
  packet.add(image.channels);
  for (const uint32_t side : {0u, 0u, image.width, image.height}) packet.add(int32_t(side));
  for (int64_t offset = 0; offset < channels; ++offset) packet.add(offset);
  for (int32_t i = 0; i < channels; ++i) packet.add(int64_t(channels));  // from one pixel to the next
  packet.add(image.values);
  return std::move(packet).finished();
}

TevImage tevImage(const std::string& name, const graph::OutputData& data) {
  if (data.desc.kind == graph::ResourceKind::Buffer)
    throw Error(ExitCode::BadInput, "a buffer is no picture", "choose an image");
  const Layout layout = layoutOf(data.desc);
  constexpr const char* kColor[] = {"R", "G", "B"};
  const uint32_t channels = std::min(layout.channels, 3u);
  TevImage image{name, layout.width, layout.height, {}, {}};
  for (uint32_t c = 0; c < channels; ++c) image.channels.emplace_back(channels == 1 ? "L" : kColor[c]);
  const std::vector<float> values = numbers(data);
  image.values.reserve(size_t(layout.width) * layout.height * channels);
  for (size_t i = 0; i < values.size(); i += layout.channels)
    for (uint32_t c = 0; c < channels; ++c)
      image.values.push_back(layout.encoded ? image::srgbDecode(values[i + c]) : values[i + c]);
  return image;
}

TevStream::TevStream(Exchange& exchange, const std::string& address) : exchange_(exchange) {
  const size_t colon = address.rfind(':');
  if (colon != std::string::npos) {
    host_ = address.substr(0, colon);
    port_ = address.substr(colon + 1);
  }
  const bool bracketed = host_.size() > 2 && host_.front() == '[' && host_.back() == ']';
  if (bracketed) host_ = host_.substr(1, host_.size() - 2);
  const bool digits =
      std::all_of(port_.begin(), port_.end(), [](unsigned char c) { return std::isdigit(c); });
  if (host_.empty() || port_.empty() || port_.size() > 5 || !digits || std::stoul(port_) > 65535)
    throw Error(ExitCode::Usage, fmt::format("--tev `{}` is not HOST:PORT", address),
                "tev listens on 127.0.0.1:14158 unless it is told otherwise");
  thread_ = std::thread([this] { run(); });
}

TevStream::~TevStream() {
  stop_ = true;
  thread_.join();
}

void TevStream::show(const std::string& source) {
  const std::lock_guard lock(mutex_);
  source_ = source;
}

std::string TevStream::source() const {
  const std::lock_guard lock(mutex_);
  return source_;
}

// `made` says for which image, size and channels the viewer has made room.
bool TevStream::sendShot(int socket, const std::string& source, const Shot& shot, std::string& made) const {
  const TevImage image = tevImage("fovea " + source, shot.data);
  const std::string create = tevCreatePacket(image);
  if (create != made && !sendAll(socket, create)) return false;
  made = create;
  return sendAll(socket, tevUpdatePacket(image));
}

void TevStream::run() {
  Socket socket(-1);
  std::string made, last;
  uint64_t number = 0;
  while (!stop_ && !exchange_.stopped()) {
    const std::string wanted = source();
    if (wanted.empty()) {
      std::this_thread::sleep_for(kShotWait);
      continue;
    }
    if (!socket || closedByPeer(socket.number())) {
      connected_ = false;
      made.clear();
      number = 0;
      socket = connectTo(host_, port_);
      if (!socket) std::this_thread::sleep_for(kRetry);
      if (!socket) continue;
      connected_ = true;
    }
    if (wanted != last) number = 0;
    last = wanted;
    const ShotPointer shot = exchange_.shot(wanted, number, kShotWait);
    if (!shot) continue;
    number = shot->number;
    if (shot->absent || !shot->refusal.empty() || shot->data.desc.kind == graph::ResourceKind::Buffer)
      continue;
    if (!sendShot(socket.number(), wanted, *shot, made)) socket = Socket(-1);
  }
}

}  // namespace fovea::view
