#include "framework/base/threads.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <vector>

namespace fovea {
namespace {

// What one call of onThreads() asks of the other threads.
struct Job {
  const std::function<void()>& work;
  uint32_t wanted = 0, running = 0;
  std::exception_ptr error;  // the first
};

class Helpers {
 public:
  void run(uint32_t count, const std::function<void()>& work) {
    Job job{work, count};
    {
      const std::lock_guard lock(mutex_);
      while (made_ < count) makeOne();
      jobs_.push_back(&job);
    }
    wake_.notify_all();
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      job.error = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    std::erase(jobs_, &job);
    done_.wait(lock, [&] { return job.running == 0; });
    if (job.error) std::rethrow_exception(job.error);
  }

 private:
  void makeOne() {
    try {
      std::thread([this] { help(); }).detach();
    } catch (const std::system_error& e) {
      throw noThread(e);
    }
    ++made_;
  }

  void help() {
    std::unique_lock lock(mutex_);
    for (;;) {
      const auto isOpen = [](const Job* job) { return job->wanted > 0; };
      auto found = jobs_.end();
      wake_.wait(lock, [&] { return (found = std::ranges::find_if(jobs_, isOpen)) != jobs_.end(); });
      Job& job = **found;
      --job.wanted;
      ++job.running;
      lock.unlock();
      std::exception_ptr error;
      try {
        job.work();
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error && !job.error) job.error = error;
      if (--job.running == 0) done_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::vector<Job*> jobs_;  // of calls that have not returned
  uint32_t made_ = 0;
};

}  // namespace

void onThreads(uint32_t count, const std::function<void()>& work) {
  if (count <= 1) return work();
  // Never destroyed, as its threads wait until the process ends, however it does.
  static Helpers& helpers = *new Helpers;
  helpers.run(count - 1, work);
}

}  // namespace fovea
