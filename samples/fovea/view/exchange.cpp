#include "samples/fovea/view/exchange.h"

#include <algorithm>

namespace fovea::view {
namespace {

constexpr auto kForgetAfter = std::chrono::seconds(3);

}  // namespace

uint64_t risingNumber() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return uint64_t(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

bool Exchange::isWanted(const Source& source) const {
  return source.waiting > 0 || Clock::now() - source.asked < kForgetAfter;
}

std::vector<Command> Exchange::takeCommands() {
  const std::lock_guard lock(mutex_);
  return std::exchange(commands_, {});
}

std::vector<std::string> Exchange::wanted() {
  const std::lock_guard lock(mutex_);
  std::erase_if(sources_, [&](const auto& entry) { return !isWanted(entry.second); });
  std::vector<std::string> names;
  for (const auto& [name, source] : sources_) names.push_back(name);
  return names;
}

bool Exchange::hungry() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(sources_.begin(), sources_.end(), [](const auto& entry) { return entry.second.hungry; });
}

bool Exchange::lacking() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(sources_.begin(), sources_.end(),
                     [&](const auto& entry) { return !entry.second.shot && isWanted(entry.second); });
}

bool Exchange::watched() const {
  const std::lock_guard lock(mutex_);
  return watchers_ > 0 || std::any_of(sources_.begin(), sources_.end(),
                                      [&](const auto& entry) { return isWanted(entry.second); });
}

void Exchange::publish(const std::string& source, Shot shot) {
  const std::lock_guard lock(mutex_);
  const auto at = sources_.find(source);
  if (at == sources_.end()) return;
  shot.number = ++shots_;
  at->second.shot = std::make_shared<const Shot>(std::move(shot));
  at->second.hungry = false;
  news_.notify_all();
}

void Exchange::clearShots() {
  const std::lock_guard lock(mutex_);
  for (auto& [name, source] : sources_) {
    source.shot.reset();
    source.hungry = true;
  }
}

void Exchange::setState(std::string json) {
  const std::lock_guard lock(mutex_);
  state_ = std::move(json);
}

void Exchange::setTick(std::string json) {
  const std::lock_guard lock(mutex_);
  tick_ = {tick_.number + 1, std::move(json)};
  news_.notify_all();
}

void Exchange::setRecording(std::string gazeTable, std::string cameraKeys) {
  const std::lock_guard lock(mutex_);
  gazeTable_ = std::move(gazeTable);
  cameraKeys_ = std::move(cameraKeys);
}

void Exchange::waitForWork(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  work_.wait_for(lock, most, [&] { return workCame_ || stopped_; });
  workCame_ = false;
}

void Exchange::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  news_.notify_all();
  work_.notify_all();
}

bool Exchange::send(Command command) {
  const std::lock_guard lock(mutex_);
  if (commands_.size() >= kMaxCommands) return false;
  commands_.push_back(std::move(command));
  workCame_ = true;
  work_.notify_all();
  return true;
}

// Makes room for another source. False if somebody waits for each of them.
bool Exchange::dropOldest() {
  auto oldest = sources_.end();
  for (auto at = sources_.begin(); at != sources_.end(); ++at)
    if (at->second.waiting == 0 && (oldest == sources_.end() || at->second.asked < oldest->second.asked))
      oldest = at;
  if (oldest == sources_.end()) return false;
  sources_.erase(oldest);
  return true;
}

ShotPointer Exchange::shot(const std::string& source, uint64_t after, std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  if (!sources_.contains(source) && sources_.size() >= kMaxSources && !dropOldest()) return nullptr;
  Source& entry = sources_[source];  // stays while somebody waits for it
  entry.asked = Clock::now();
  const auto isNew = [&] { return entry.shot && entry.shot->number > after; };
  if (!isNew()) {
    entry.hungry = workCame_ = true;
    work_.notify_all();
    ++entry.waiting;
    news_.wait_for(lock, most, [&] { return isNew() || stopped_; });
    --entry.waiting;
    entry.asked = Clock::now();
  }
  return isNew() ? entry.shot : nullptr;
}

std::string Exchange::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::string Exchange::gazeTable() const {
  const std::lock_guard lock(mutex_);
  return gazeTable_;
}

std::string Exchange::cameraKeys() const {
  const std::lock_guard lock(mutex_);
  return cameraKeys_;
}

std::optional<Exchange::Tick> Exchange::tick(uint64_t after, std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, most, [&] { return tick_.number > after || stopped_; });
  if (tick_.number <= after) return std::nullopt;
  return tick_;
}

bool Exchange::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

void Exchange::addWatcher(int change) {
  const std::lock_guard lock(mutex_);
  watchers_ += change;
  workCame_ = true;
  work_.notify_all();
}

}  // namespace fovea::view
