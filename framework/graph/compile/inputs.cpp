// Resolve, inputs: those of the whole graph are the caller's memory, those of a sub-graph are wired by its parent.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "framework/gpu/format.h"
#include "framework/graph/compile/expand.h"

namespace fovea::graph::detail {

using json::Member;

bool isName(std::string_view name) {
  bool good = !name.empty();
  for (const char c : name)
    good &=
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  return good;
}

int64_t Expander::readSize(Scope& scope, json::ObjectReader& reader, const char* key, int64_t fallback) {
  const json::Value* value = reader.find(key);
  if (!value) return fallback;
  ParameterDescription size;
  if (!readScalar(scope, *value, reader.pathOf(key), size)) return fallback;
  int64_t number = size.integer;
  if (size.type == json::Value::Type::String && size.fromCommandLine) {
    const std::string_view text = description_.symbols[size.text];
    const auto [at, ec] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (ec == std::errc() && at == text.data() + text.size()) size.type = json::Value::Type::Int;
  }
  if (size.type == json::Value::Type::Int && number >= 1 && number <= int64_t(1) << 31) return number;
  error(value->where, reader.pathOf(key),
        fmt::format("`{}`: expected a whole number from 1 to {}, found {}", key, int64_t(1) << 31,
                    value->describe()));
  return fallback;
}

ResourceDesc Expander::readResource(Scope& scope, json::ObjectReader& reader) {
  ResourceDesc desc;
  if (const json::Value* format = reader.has("format") ? reader.find("format") : nullptr) {
    desc.format = format->isString() ? gpu::formatFromName(format->string) : VK_FORMAT_UNDEFINED;
    if (desc.format == VK_FORMAT_UNDEFINED) {
      std::vector<std::string> names;
      for (const gpu::FormatInfo& info : gpu::formats()) names.emplace_back(info.name);
      error(format->where, reader.pathOf("format"), fmt::format("no texel format: {}", format->describe()),
            nearestRemedy(format->string, names));
    }
    desc.volume = reader.has("depth");
    desc.array = reader.has("layers");
    desc.width = static_cast<uint32_t>(readSize(scope, reader, "width", 0));
    desc.height = static_cast<uint32_t>(readSize(scope, reader, "height", 0));
    desc.depth = static_cast<uint32_t>(readSize(scope, reader, "depth", 1));
    desc.layers = static_cast<uint32_t>(readSize(scope, reader, "layers", 1));
    desc.mips = static_cast<uint32_t>(readSize(scope, reader, "mips", 1));
    if (desc.mips > 32) desc.mips = 32;
    if (desc.volume && desc.array)
      error(reader.value().where, reader.pathOf("layers"), "an image has `depth` or `layers`, not both");
    return desc;
  }
  desc.kind = ResourceKind::Buffer;
  if (!reader.has("element")) {
    error(reader.value().where, reader.path(),
          "an input needs a `format` (image), an `element` (buffer) or a `bundle`");
    // One message is enough, because the other members may well belong to this one.
    for (const char* key : {"format", "bundle", "members", "width", "height", "depth", "layers", "mips"})
      reader.find(key);
  }
  const std::string element = reader.text("element");
  desc.stride = static_cast<uint32_t>(readSize(scope, reader, "stride", 4));
  desc.count = static_cast<uint64_t>(readSize(scope, reader, "count", 1));
  desc.element = element;
  return desc;
}

void Expander::readRootInputs(Scope& scope) {
  const json::Value* inputs = scope.document->find("inputs");
  if (!inputs || !inputs->isObject()) return;
  for (const Member& member : inputs->members) {
    const std::string path = json::joinPath("inputs", member.key);
    if (!isName(member.key))
      error(member.keyWhere, path, fmt::format("`{}` is no name for an input", member.key),
            "letters, digits, _ and -");
    json::ObjectReader reader(member.value, path, diagnostics_);
    if (!member.value.isObject()) continue;
    reader.text("doc");
    ExternalDescription external;
    external.name = intern(member.key);
    external.bundle = intern("");
    external.place = place(member.keyWhere);
    if (reader.has("bundle")) {
      external.bundle = intern(reader.text("bundle"));
      if (const json::Value* members = reader.object("members")) {
        for (const Member& m : members->members) {
          json::ObjectReader memberReader(m.value, json::joinPath(path, "members." + m.key), diagnostics_);
          if (!m.value.isObject()) continue;
          external.members.push_back(intern(m.key));
          external.resources.push_back(readResource(scope, memberReader));
          memberReader.finish();
        }
      } else {
        reader.require("members");
      }
    } else {
      external.members.push_back(intern(""));
      external.resources.push_back(readResource(scope, reader));
    }
    reader.finish();
    Scope::Input input;
    input.name = member.key;
    input.external = static_cast<uint32_t>(description_.externals.size());
    input.place = external.place;
    scope.inputs.push_back(std::move(input));
    description_.externals.push_back(std::move(external));
  }
}

void Expander::readInputs(Scope& scope, const json::Value* wires) {
  if (const json::Value* inputs = scope.document->find("inputs"); inputs && inputs->isObject()) {
    for (const Member& member : inputs->members) {
      json::ObjectReader reader(member.value, json::joinPath("inputs", member.key), diagnostics_);
      reader.text("doc");
      Scope::Input input;
      input.name = member.key;
      input.optional = reader.boolean("optional", false);
      input.place = place(member.keyWhere);
      reader.finish();
      scope.inputs.push_back(std::move(input));
    }
  }
  if (wires && wires->isObject()) {
    for (const Member& member : wires->members) {
      const std::string path = json::joinPath(scope.path, "inputs." + member.key);
      Scope::Input* input = scope.findInput(member.key);
      if (!input) {
        std::vector<std::string> names;
        for (const Scope::Input& i : scope.inputs) names.push_back(i.name);
        error(member.keyWhere, path, fmt::format("the sub-graph has no input `{}`", member.key),
              nearestRemedy(member.key, names));
      } else if (!member.value.isString()) {
        error(member.value.where, path,
              fmt::format("expected a wire such as \"pass.port\", found {}", member.value.describe()));
        input->optional = true;  // one message is enough
      } else {
        input->wire = &member.value;
      }
    }
  }
}

}  // namespace fovea::graph::detail
