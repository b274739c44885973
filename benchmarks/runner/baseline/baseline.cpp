#include "benchmarks/runner/baseline/baseline.h"

#include <fstream>

#include "framework/base/json.h"

namespace fovea::bench {
namespace {

using json::ObjectReader;
using json::Value;

constexpr const char* kRemedy = "name a file that `fovea bench passes -o FILE` wrote, or a program `fovea`";

// A list with a number for each frame.
void checkNumbers(const Value& list, const std::string& path, Diagnostics& errors) {
  bool good = list.isArray() && !list.items.empty();
  for (const Value& item : list.items) good &= item.isNumber();
  if (!good)
    errors.error(list.where.location(), path,
                 "expected a list of numbers, one for each frame" +
                     (list.isArray() ? std::string() : ", found " + list.describe()),
                 kRemedy);
}

void checkTimes(const Value& times, const std::string& path, std::initializer_list<const char*> clocks,
                Diagnostics& errors) {
  ObjectReader r(times, path, errors);
  for (const char* clock : clocks)
    if (const Value* list = r.require(clock)) checkNumbers(*list, r.pathOf(clock), errors);
  r.boolean("host", false);
}

void checkRepeat(const Value& repeat, const std::string& path, Diagnostics& errors) {
  ObjectReader r(repeat, path, errors);
  for (const char* part : {"passes", "frame", "counters"}) r.require(part);
  if (const Value* passes = r.object("passes"))
    for (const json::Member& pass : passes->members)
      checkTimes(pass.value, json::joinPath(r.pathOf("passes"), pass.key), {"gpu_ms", "cpu_ms"}, errors);
  if (const Value* frame = r.object("frame"))
    checkTimes(*frame, r.pathOf("frame"), {"gpu_ms", "cpu_ms", "wall_ms"}, errors);
  if (const Value* counters = r.object("counters"))
    for (const json::Member& counter : counters->members)
      checkNumbers(counter.value, json::joinPath(r.pathOf("counters"), counter.key), errors);
}

}  // namespace

nlohmann::ordered_json readBaseline(const std::string& file) {
  const Value root = json::parseFile(file);
  Diagnostics errors;
  ObjectReader r(root, "", errors);
  r.require("with");
  r.object("with");
  const Value* repeats = r.require("repeats") ? r.array("repeats") : nullptr;
  if (repeats && repeats->items.empty())
    errors.error(repeats->where.location(), "repeats", "a baseline has at least one repeat", kRemedy);
  for (size_t i = 0; repeats && i < repeats->items.size(); ++i)
    checkRepeat(repeats->items[i], "repeats[" + std::to_string(i) + "]", errors);
  errors.throwIfErrors();
  std::ifstream in(file, std::ios::binary);
  return nlohmann::ordered_json::parse(in);
}

}  // namespace fovea::bench
