// The exchange between the thread that renders and the threads that answer pages. The former never waits for the
// latter: it leaves the newest pictures and messages here and takes the requests.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fovea/graph.h"
#include "fovea/image.h"
#include "samples/fovea/view/command.h"

namespace fovea::view {

// Start of a counter that has to keep rising when the program restarts itself, since pages outlive a restart:
// microseconds since 1970.
uint64_t risingNumber();

// What a source showed in one frame.
struct Shot {
  uint64_t number = 0;  // counts all that were published
  uint64_t frame = 0;   // Frame::index
  float exposure = 1;   // of the graph or, if it has none, of the scene
  glm::vec2 gaze{0.5f};
  float foveaRadius = 0;                            // in widths of the picture
  uint32_t frames = 1;                              // of which this is the mean
  std::shared_ptr<const image::Metadata> metadata;  // of the frame, as `fovea render` writes it
  graph::OutputData data;
  std::string refusal;  // why there is no picture; empty if there is one
  bool absent = false;  // there is none for now, through no fault of the client
};
using ShotPointer = std::shared_ptr<const Shot>;

class Exchange {
 public:
  using Clock = std::chrono::steady_clock;

  // ---- for the thread that renders -----------------------------------------------------------------------------

  std::vector<Command> takeCommands();
  // The sources of which pictures are wanted, sorted. Those not requested for three seconds are dropped.
  std::vector<std::string> wanted();
  // Whether a client waits for a picture, having taken the last one.
  bool hungry() const;
  // Whether a source is wanted of which there is no picture yet.
  bool lacking() const;
  // Whether a page is there.
  bool watched() const;
  void publish(const std::string& source, Shot shot);
  // Forgets all pictures: those of another graph are not to be shown any more.
  void clearShots();
  void setState(std::string json);  // what a page has to know once for each build of the graph
  void setTick(std::string json);   // what changes with every frame
  void setRecording(std::string gazeTable, std::string cameraKeys);
  // Waits until a command or a wish for a picture arrives, but not longer than this.
  void waitForWork(std::chrono::milliseconds most);
  // Lets all who wait return at once.
  void stop();

  // ---- for the threads that answer pages -----------------------------------------------------------------------

  // False if too many commands wait already.
  bool send(Command command);
  // The newest picture of a source with a number above `after`; waits for it, but not longer than `most`. nullptr if
  // there is none by then, or if others wait for too many sources.
  ShotPointer shot(const std::string& source, uint64_t after, std::chrono::milliseconds most);
  std::string state() const;
  std::string gazeTable() const;
  std::string cameraKeys() const;
  struct Tick {
    uint64_t number = 0;
    std::string json;
  };
  // The newest tick after this one; waits for it, but not longer than `most`. nullopt if there is none by then.
  std::optional<Tick> tick(uint64_t after, std::chrono::milliseconds most);
  bool stopped() const;
  void addWatcher(int change);  // a page that listens to ticks has come (1) or gone (-1)

  static constexpr size_t kMaxSources = 8, kMaxCommands = 256;

 private:
  struct Source {
    ShotPointer shot;
    Clock::time_point asked;
    uint32_t waiting = 0;
    bool hungry = false;
  };
  bool dropOldest();
  bool isWanted(const Source& source) const;

  mutable std::mutex mutex_;
  std::condition_variable news_, work_;
  std::vector<Command> commands_;
  std::map<std::string, Source> sources_;
  std::string state_, gazeTable_, cameraKeys_;
  Tick tick_;
  uint64_t shots_ = risingNumber();
  int watchers_ = 0;
  bool stopped_ = false, workCame_ = false;
};

}  // namespace fovea::view
