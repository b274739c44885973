// Resolve, inputs: those of the whole graph are the caller's memory, those of a sub-graph are wired by its parent.
#include <fmt/format.h>

#include <algorithm>

#include "framework/gpu/format.h"
#include "framework/graph/resolve/expand.h"

namespace fovea::graph::detail {

using json::Member;

namespace {

int64_t readSize(Expansion& all, Scope& scope, json::ObjectReader& reader, const char* key,
                 int64_t fallback) {
  const json::Value* value = reader.find(key);
  ParameterDescription size;
  if (!value || !readScalar(all, scope, *value, size)) return fallback;
  json::Value number = *size.value;
  if (number.isString() && size.fromCommandLine) {
    json::Value typed;
    if (readTyped(number.string, json::Value::Type::Int, typed)) number = typed;
  }
  if (number.isInt() && number.integer >= 1 && number.integer <= int64_t(1) << 31) return number.integer;
  report(all, scope, size.value->where, *value,
         fmt::format("`{}`: expected a whole number from 1 to {}, found {}", key, int64_t(1) << 31,
                     number.describe()));
  return fallback;
}

ResourceDesc readImage(Expansion& all, Scope& scope, json::ObjectReader& reader, const json::Value& format) {
  ResourceDesc desc;
  desc.format = gpu::formatFromName(format.string);
  if (desc.format == VK_FORMAT_UNDEFINED) {
    std::vector<std::string> names;
    for (const gpu::FormatInfo& info : gpu::formats()) names.emplace_back(info.name);
    report(all, scope, format, fmt::format("no texel format: {}", format.describe()),
           nearestRemedy(format.string, names));
  }
  desc.light = reader.boolean("light", false) ? 1 : 0;
  if (desc.light > 0 && desc.format != VK_FORMAT_UNDEFINED && !gpu::holdsLight(desc.format))
    report(all, scope, format, "texels of the format `" + format.string + "` cannot hold light",
           "use a format of 16- or 32-bit floats, such as rgba16f");
  const auto size = [&](const char* key, int64_t fallback) {
    return static_cast<uint32_t>(readSize(all, scope, reader, key, fallback));
  };
  desc.volume = reader.has("depth");
  desc.array = reader.has("layers");
  desc.width = size("width", 0);
  desc.height = size("height", 0);
  desc.depth = size("depth", 1);
  desc.layers = size("layers", 1);
  desc.mips = std::min(size("mips", 1), 32u);
  if (desc.volume && desc.array)
    report(all, scope, reader.value().where, *reader.value().find("layers"),
           "an image has `depth` or `layers`, not both");
  return desc;
}

ResourceDesc readResource(Expansion& all, Scope& scope, json::ObjectReader& reader) {
  if (reader.has("format")) return readImage(all, scope, reader, *reader.find("format"));
  ResourceDesc desc;
  desc.kind = ResourceKind::Buffer;
  if (!reader.has("element")) {
    report(all, scope, reader.value(),
           "an input needs a `format` (image), an `element` (buffer) or a `bundle`");
    // One message is enough, because the other members may well belong to this one.
    for (const char* key : {"format", "bundle", "members", "width", "height", "depth", "layers", "mips"})
      reader.find(key);
  }
  desc.element = reader.text("element");
  desc.stride = static_cast<uint32_t>(readSize(all, scope, reader, "stride", 4));
  desc.count = static_cast<uint64_t>(readSize(all, scope, reader, "count", 1));
  return desc;
}

ExternalDescription readExternal(Expansion& all, Scope& scope, const Member& member,
                                 json::ObjectReader& reader) {
  ExternalDescription external{member.key, {}, {}, {}, member.keyWhere};
  reader.text("doc");
  if (!reader.has("bundle")) {
    external.members.emplace_back();
    external.resources.push_back(readResource(all, scope, reader));
  } else {
    external.bundle = reader.text("bundle");
    const json::Value* members = reader.object("members");
    if (!members) {
      reader.require("members");
      reader.finish();
      return external;
    }
    for (const Member& m : members->members) {
      json::ObjectReader memberReader(m.value, reader.pathOf("members." + m.key), all.diagnostics);
      if (!m.value.isObject()) continue;
      external.members.push_back(m.key);
      external.resources.push_back(readResource(all, scope, memberReader));
      memberReader.finish();
    }
  }
  reader.finish();
  return external;
}

}  // namespace

void readRootInputs(Expansion& all, Scope& scope) {
  const json::Value* inputs = scope.document->find("inputs");
  if (!inputs || !inputs->isObject()) return;
  for (const Member& member : inputs->members) {
    if (!isName(member.key))
      report(all, scope, member.keyWhere, member.value,
             fmt::format("`{}` is no name for an input", member.key), "letters, digits, _ and -");
    json::ObjectReader reader(member.value, json::joinPath("inputs", member.key), all.diagnostics);
    if (!member.value.isObject()) {
      scope.broken.push_back("inputs." + member.key);
      continue;
    }
    std::vector<ExternalDescription>& externals = all.description.externals;
    const size_t before = all.diagnostics.list().size();
    ExternalDescription external = readExternal(all, scope, member, reader);
    if (all.diagnostics.list().size() > before) {
      scope.broken.push_back("inputs." + member.key);
      continue;
    }
    scope.inputs.push_back({&member, false, false, nullptr, static_cast<uint32_t>(externals.size())});
    externals.push_back(std::move(external));
  }
}

void readInputs(Expansion& all, Scope& scope, const json::Value* wires) {
  if (const json::Value* inputs = scope.document->find("inputs"); inputs && inputs->isObject()) {
    for (const Member& member : inputs->members) {
      json::ObjectReader reader(member.value, json::joinPath("inputs", member.key), all.diagnostics);
      reader.text("doc");
      scope.inputs.push_back({&member, reader.boolean("optional", false)});
      reader.finish();
    }
  }
  if (!wires) return;
  for (const Member& member : wires->members) {
    Scope::Input* input = scope.findInput(member.key);
    if (!input) {
      std::vector<std::string> names;
      for (const Scope::Input& i : scope.inputs) names.push_back(i.declared->key);
      report(all, *scope.parent, member.keyWhere, member.value,
             fmt::format("the sub-graph has no input `{}`", member.key), nearestRemedy(member.key, names));
    } else if (!member.value.isString()) {
      report(all, *scope.parent, member.value,
             fmt::format("expected a wire such as \"pass.port\", found {}", member.value.describe()));
      input->optional = true;  // one message is enough
    } else {
      input->wire = &member.value;
    }
  }
}

}  // namespace fovea::graph::detail
