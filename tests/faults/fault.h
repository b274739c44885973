// How a function interprets FOVEA_FAULTS, a list as "vkMapMemory=-5,pthread_create=11@3": the result of the function's
// every call ("=-5"), of the call with one number, counted from 0 ("=11@3"), or of that and all that follow ("=11@3+").
#pragma once

#include <atomic>
#include <cstdlib>
#include <optional>
#include <string>

class Fault {
 public:
  explicit Fault(const char* function) {
    const char* variable = std::getenv("FOVEA_FAULTS");
    const std::string list = "," + std::string(variable ? variable : "") + ",",
                      start = "," + std::string(function) + "=";
    const size_t at = list.find(start);
    if (at == std::string::npos) return;
    const std::string fault = list.substr(at + start.size(), list.find(',', at + 1) - at - start.size());
    result_ = std::atoi(fault.c_str());
    const size_t number = fault.find('@');
    if (number != std::string::npos) first_ = std::atoi(&fault[number + 1]);
    once_ = number != std::string::npos && fault.back() != '+';
  }

  // Counts a call; its result if it fails.
  std::optional<int> next() {
    const int call = calls_++;
    return call == first_ || (call > first_ && !once_) ? result_ : std::nullopt;
  }

 private:
  std::optional<int> result_;
  int first_ = 0;
  bool once_ = false;
  std::atomic<int> calls_{0};
};
