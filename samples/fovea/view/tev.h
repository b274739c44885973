// Sends a picture of the run to tev (https://github.com/Tom94/tev), frame after frame, by its protocol over TCP.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "samples/fovea/view/exchange.h"

namespace fovea::view {

// A packet of tev that makes an image, and one that fills it. Channels are 32-bit floats; `values` holds pixel after
// pixel, from the upper left corner.
struct TevImage {
  std::string name;
  uint32_t width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> values;
};
std::string tevCreatePacket(const TevImage& image);
std::string tevUpdatePacket(const TevImage& image);

// What tev is to show of a picture: radiance as it is, and values that are meant for a display as linear light. Alpha is
// left out, as in EXR files. Throws Error(BadInput) for a buffer.
TevImage tevImage(const std::string& name, const graph::OutputData& data);

// Connects, and connects again whenever that fails; the run never waits for it.
class TevStream {
 public:
  // `address` is HOST:PORT. Throws Error(Usage) if it is not.
  TevStream(Exchange& exchange, const std::string& address);
  ~TevStream();
  TevStream(const TevStream&) = delete;
  TevStream& operator=(const TevStream&) = delete;

  void show(const std::string& source);  // "" for nothing
  std::string source() const;
  bool connected() const { return connected_; }

 private:
  void run();
  bool sendShot(int socket, const std::string& source, const Shot& shot, std::string& made) const;

  Exchange& exchange_;
  std::string host_, port_;
  mutable std::mutex mutex_;
  std::string source_;
  std::atomic<bool> stop_ = false, connected_ = false;
  std::thread thread_;
};

}  // namespace fovea::view
