// Random pass types and random graphs of them, as text; the same seed gives the same text on every machine.
#pragma once

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/graph_support.h"

namespace fovea::graph::test {

class Dice {
 public:
  explicit Dice(uint32_t seed) : seed_(hashPcg(seed)) {}
  // The first rolls are these bytes, for a fuzzer to choose; they must outlive the dice.
  explicit Dice(std::string_view rolls) : seed_(0), rolls_(rolls) {}
  uint32_t operator()(uint32_t sides) {
    if (rolls_.empty()) return hashCombine(seed_, ++count_) % sides;
    const uint32_t roll = static_cast<unsigned char>(rolls_[0]);
    rolls_.remove_prefix(1);
    return sides <= 256 ? roll % sides : (roll << 8 | (*this)(256)) % sides;
  }
  bool chance(uint32_t percent) { return (*this)(100) < percent; }

 private:
  uint32_t seed_, count_ = 0;
  std::string_view rolls_;
};

// Kinds of value that the random ports carry.
enum RandomKind : uint32_t { kRandomImage, kRandomDepth, kRandomBuffer, kRandomKinds };

inline ResourceSpec randomResource(RandomKind kind, bool output) {
  const SizeExpr side = output ? parameter("side") : SizeExpr(1);
  if (kind == kRandomImage) return image2D(kColor, side, side);
  if (kind == kRandomDepth) return image2D(kDepth, side, side);
  return buffer("Item", 16, output ? parameter("side") * SizeExpr(64) : SizeExpr(1));
}

inline Usage randomRead(PassKind pass, RandomKind kind, Dice& dice) {
  if (pass == PassKind::Host) return Usage::HostRead;
  const uint32_t roll = dice(6);
  if (kind == kRandomBuffer) {
    const Usage usages[] = {Usage::StorageRead, Usage::Uniform,      Usage::TexelRead,
                            Usage::Indirect,    Usage::TransferRead, Usage::StorageRead | Usage::Indirect};
    return usages[roll];
  }
  const bool depthTest = kind == kRandomDepth && pass != PassKind::Compute;
  const Usage usages[] = {
      Usage::Sampled,
      Usage::Sampled,
      kind == kRandomDepth ? Usage::Sampled : Usage::StorageRead,
      Usage::TransferRead,
      depthTest ? Usage::DepthAttachment : Usage::Sampled,
      depthTest ? Usage::DepthAttachment | Usage::Sampled : Usage::Sampled | Usage::TransferRead};
  return usages[roll];
}

inline Usage randomWrite(PassKind pass, RandomKind kind, Dice& dice) {
  if (pass == PassKind::Host) return Usage::HostWrite;
  if (kind == kRandomDepth)
    return pass == PassKind::Compute || dice.chance(20) ? Usage::TransferWrite : Usage::DepthAttachment;
  if (kind == kRandomImage && pass != PassKind::Compute && dice.chance(60)) return Usage::ColorAttachment;
  const Usage usages[] = {Usage::StorageWrite, Usage::StorageRead | Usage::StorageWrite, Usage::TransferWrite,
                          Usage::TransferWrite | Usage::StorageWrite};
  return usages[dice(4)];
}

struct RandomPort {
  std::string name;
  RandomKind kind;
  Direction direction;
  bool kept = false, optional = false;
};

struct RandomType {
  std::string name;
  std::vector<RandomPort> ports;
};

// Forty types with up to four inputs, in-out ports, kept outputs, scratch, host passes and side effects.
// `finish` may add to a type before it is registered.
inline std::vector<RandomType> addRandomTypes(
    Registry& registry, uint32_t seed, uint32_t count = 40,
    const std::function<void(PassDeclaration&)>& finish = [](PassDeclaration&) {}) {
  std::vector<RandomType> types;
  Dice dice(seed);
  for (uint32_t t = 0; t < count; ++t) {
    const PassKind kinds[] = {PassKind::Compute,
                              PassKind::Compute,
                              PassKind::Compute,
                              PassKind::Graphics,
                              PassKind::ComputeAndGraphics,
                              PassKind::Host};
    RandomType type{fmt::format("type{}", t), {}};
    PassDeclaration d(type.name, "Random", kinds[dice(6)]);
    d.parameter("side", integer(4, 1, 64), "size of everything it makes");
    d.sideEffects = dice.chance(4);
    const uint32_t inputs = t < 6 ? 0 : dice(5);
    for (uint32_t i = 0; i < inputs; ++i) {
      const RandomKind kind = static_cast<RandomKind>(dice(kRandomKinds));
      const bool inout = dice.chance(18);
      RandomPort port{fmt::format("in{}", i), kind, inout ? Direction::InOut : Direction::Input};
      if (inout) {
        const Usage usage = randomWrite(d.kind, kind, dice);
        d.inout(port.name, randomResource(kind, false), usage, "changed");
      } else {
        port.optional = dice.chance(25);
        d.input(port.name, randomResource(kind, false), randomRead(d.kind, kind, dice), "read").optional =
            port.optional;
      }
      type.ports.push_back(port);
    }
    const uint32_t outputs = 1 + dice(2);
    for (uint32_t o = 0; o < outputs; ++o) {
      const RandomKind kind =
          t < 6 ? static_cast<RandomKind>(t % kRandomKinds) : static_cast<RandomKind>(dice(kRandomKinds));
      RandomPort port{fmt::format("out{}", o), kind, Direction::Output, dice.chance(12), false};
      PortSpec& spec =
          d.output(port.name, randomResource(kind, true), randomWrite(d.kind, kind, dice), "made");
      if (port.kept) spec.keep(dice.chance(50) ? Lifetime::View : Lifetime::Scene);
      type.ports.push_back(port);
    }
    if (dice.chance(30))
      d.scratch("own", randomResource(kRandomBuffer, true),
                d.kind == PassKind::Host ? Usage::HostWrite : Usage::StorageWrite, "scratch");
    finish(d);
    registry.add(d, nullptr);
    types.push_back(type);
  }
  return types;
}

// A graph that is valid in nearly all cases; the exceptions are orders that updates in place make impossible.
inline std::string randomGraph(const std::vector<RandomType>& types, Dice& dice, uint32_t maxPasses = 36) {
  const uint32_t count = 2 + dice(maxPasses - 1);
  struct Offer {
    std::string wire;
    RandomKind kind;
    bool kept, updated;
  };
  std::vector<const RandomType*> chosen;
  for (uint32_t p = 0; p < count; ++p) chosen.push_back(&types[dice(static_cast<uint32_t>(types.size()))]);
  std::vector<Offer> offers;
  std::set<std::pair<uint32_t, uint32_t>> externals;  // number, kind
  std::string passes;
  for (uint32_t p = 0; p < count; ++p) {
    std::string inputs;
    std::vector<Offer> made;
    std::set<std::string> used, updating;  // a pass that reads a value cannot update it too
    uint32_t external = 0;
    for (const RandomPort& port : chosen[p]->ports) {
      if (port.direction == Direction::Output) {
        made.push_back({fmt::format("p{}.{}", p, port.name), port.kind, port.kept, false});
        continue;
      }
      if (port.optional && dice.chance(40)) continue;
      std::vector<Offer*> fitting;
      for (Offer& offer : offers)
        if (offer.kind == port.kind &&
            (port.direction == Direction::Input ? !updating.count(offer.wire) : !used.count(offer.wire)) &&
            (!offer.updated || (port.direction == Direction::Input && dice.chance(1))))
          fitting.push_back(&offer);
      std::string wire;
      if (port.direction == Direction::Input && dice.chance(15)) {
        wire = fmt::format("?{}?", static_cast<int>(port.kind));
      } else if (fitting.empty() || dice.chance(4)) {
        // An update in place only where nobody else reads, so it has an input of its own.
        const uint32_t number = port.direction == Direction::InOut ? p * 8 + ++external : 0;
        externals.insert({number, port.kind});
        wire = fmt::format("inputs.e{}_{}", static_cast<int>(port.kind), number);
      } else {
        // Mostly recent values, so that there are lifetimes of all lengths.
        const uint32_t n = static_cast<uint32_t>(fitting.size());
        Offer& offer = *fitting[dice.chance(70) ? n - 1 - dice(std::min(n, 4u)) : dice(n)];
        wire = offer.wire;
        used.insert(wire);
        if (port.direction == Direction::InOut) updating.insert(wire);
        if (port.direction == Direction::InOut) offer.updated = true;
      }
      if (port.direction == Direction::InOut)
        made.push_back({fmt::format("p{}.{}", p, port.name), port.kind, true, false});
      inputs += fmt::format("{}\"{}\": \"{}\"", inputs.empty() ? "" : ", ", port.name, wire);
    }
    offers.insert(offers.end(), made.begin(), made.end());
    passes +=
        fmt::format("{}\n  \"p{}\": {{\"type\": \"{}\", \"inputs\": {{{}}}, \"params\": {{\"side\": {}}}}}",
                    p ? "," : "", p, chosen[p]->name, inputs, 1 + dice(64));
  }
  // Values of the last frame, from any pass, also from later ones.
  for (size_t at = passes.find('?'); at != std::string::npos; at = passes.find('?')) {
    const RandomKind kind = static_cast<RandomKind>(passes[at + 1] - '0');
    std::vector<std::string> fitting;
    for (const Offer& offer : offers)
      if (offer.kind == kind && !offer.kept && !offer.updated) fitting.push_back(offer.wire + "@previous");
    if (fitting.empty()) externals.insert({0, kind});
    passes.replace(at, 3,
                   fitting.empty() ? fmt::format("inputs.e{}_0", static_cast<int>(kind))
                                   : fitting[dice(static_cast<uint32_t>(fitting.size()))]);
  }
  std::string inputs, outputs;
  const char* specs[] = {R"({"format": "rgba16f", "width": 8, "height": 8})",
                         R"({"format": "d32f", "width": 8, "height": 8})",
                         R"({"element": "Item", "stride": 16, "count": 64})"};
  for (const auto& [number, kind] : externals)
    inputs += fmt::format("{}\"e{}_{}\": {}", inputs.empty() ? "" : ", ", kind, number, specs[kind]);
  const uint32_t outputCount = 1 + dice(3);
  for (uint32_t o = 0; o < outputCount || (outputs.empty() && o < 100); ++o) {
    const Offer& offer = offers[dice(static_cast<uint32_t>(offers.size()))];
    if (!offer.updated)
      outputs += fmt::format("{}\"o{}\": \"{}\"", outputs.empty() ? "" : ", ", o, offer.wire);
  }
  return fmt::format("{{\"inputs\": {{{}}},\n\"passes\": {{{}\n}},\n\"outputs\": {{{}}}}}", inputs, passes,
                     outputs);
}

inline std::string randomGraph(const std::vector<RandomType>& types, uint32_t seed, uint32_t maxPasses = 36) {
  Dice dice(seed);
  return randomGraph(types, dice, maxPasses);
}

// Sizes, alignments and memory types of the resources of a graph, as a strange driver might want them.
inline MemoryTable randomMemory(uint32_t seed, std::shared_ptr<const BoundGraph> graph) {
  return [seed, graph](uint32_t resource) {
    Dice dice(hashCombine(seed, resource));
    MemoryNeed need = estimateMemory(graph->resources[resource].desc);
    need.alignment = uint64_t(1) << dice(13);
    need.bytes += dice(5000);
    if (dice.chance(30)) need.memoryTypeBits = 6;
    return need;
  };
}

}  // namespace fovea::graph::test
