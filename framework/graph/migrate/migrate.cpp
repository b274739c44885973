// What changed from one version of graph files to the next: the tables, and how they are applied to a document.
#include "framework/graph/migrate/migrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace fovea::graph {
namespace {

using json::Member;
using json::Value;

// ---- From version 1 to version 2 -----------------------------------------------------------------------------

// Pass types that had their place of work at the end of their names: NAME-host, NAME-device, NAME-$rays.
constexpr std::string_view kRayPasses[] = {
    "contact-rays",      "eye-paths",  "gi-samples",  "near-field",
    "near-field-pixels", "probe-rays", "reflections", "reservoirs-visibility",
    "shadow-rays"};
// Graph parameters that chose it, where they are texts.
constexpr std::string_view kRayParameters[] = {"rays", "tracer"};

// Parameters that belong to the frame now, and the pass types that had them.
struct ToView {
  std::string_view parameter;
  std::vector<std::string_view> types;
};
const ToView kToView[] = {{"materials",
                           {"compose", "contact-rays", "deferred", "direct", "emit", "eye-paths", "gbuffer",
                            "gi-samples", "near-field", "near-field-pixels", "path-trace", "probe-rays",
                            "reflections", "reservoirs-visibility", "shadow-rays", "temporal-accumulation"}},
                          {"fovea_radius",
                           {"candidates", "contacts", "deferred", "eye-paths", "gi-samples", "near-field",
                            "probe-rays", "shadow-rays", "vpl-intensity", "weight-map"}},
                          {"pixels_per_degree", {"deferred", "shadow-rays"}},
                          {"jitter", {"antialias"}}};

// Defaults of such parameters that were others than those of the frame are.
constexpr int64_t kJitterOfAntialias = 8;
constexpr std::string_view kMaterialsOfPasses = "diffuse", kMaterialsOfScene = "$scene.materials";

// A fovea of at least so many picture widths, with which pass near-field spared nothing, and what says so now.
constexpr double kWholePicture = 1;
constexpr int64_t kFinestSpacing = 2;

// Graph parameters of `foveal` and the graphs that extend it, and the parameters of passes that they were.
struct ToPass {
  std::string_view parameter, pass, name;
};
constexpr ToPass kToPass[] = {{"placement", "manage", "placement"},
                              {"light_floor", "manage", "light_floor"},
                              {"turnover", "manage", "turnover"},
                              {"change_turnover", "manage", "change_turnover"},
                              {"reuse", "manage", "reuse"},
                              {"fade_frames", "vpl-intensity", "fade_frames"},
                              {"area_cap", "vpl-intensity", "area_cap"},
                              {"mover_slack", "shadow-atlas", "mover_slack"},
                              {"paths", "eye-paths", "paths"},
                              {"renew_frames", "eye-paths", "renew_frames"},
                              {"saccade_renew_frames", "eye-paths", "saccade_renew_frames"},
                              {"stray", "eye-paths", "stray"},
                              {"trace_frames", "eye-paths", "trace_frames"},
                              {"history_frames", "indirect-mean", "frames"},
                              {"first_samples", "near-field", "first_samples"},
                              {"first_samples", "near-field-mean", "first_samples"},
                              {"plane_tolerance", "motion-vectors", "plane_tolerance"},
                              {"plane_tolerance", "near-field-mean", "plane_tolerance"},
                              {"plane_tolerance", "deferred", "filter_plane"},
                              {"plane_tolerance", "reflection-vectors", "plane_tolerance"},
                              {"plane_tolerance", "reflections-mean", "plane_tolerance"},
                              {"antialias_frames", "antialias", "frames"},
                              {"only_veils", "antialias", "only_veils"}};

// ---- Documents -----------------------------------------------------------------------------------------------

Value* findIn(Value* object, std::string_view key) {
  if (object)
    for (Member& member : object->members)
      if (member.key == key) return &member.value;
  return nullptr;
}

std::string_view textIn(Value* object, std::string_view key) {
  const Value* value = findIn(object, key);
  return value && value->isString() ? std::string_view(value->string) : std::string_view();
}

void removeFrom(Value& object, std::string_view key) {
  std::erase_if(object.members, [&](const Member& member) { return member.key == key; });
}

// What is new has no line, by which it is told from what was read.
Member newMember(std::string_view key, Value::Type type, const Value& object) {
  Member member;
  member.key = key;
  member.keyWhere.file = object.where.file;
  member.value.type = type;
  member.value.where = member.keyWhere;
  return member;
}

Member newNumber(std::string_view key, int64_t number, const Value& object) {
  Member member = newMember(key, Value::Type::Int, object);
  member.value.integer = number;
  member.value.real = double(number);
  return member;
}

Member newText(std::string_view key, std::string text, const Value& object) {
  Member member = newMember(key, Value::Type::String, object);
  member.value.string = std::move(text);
  return member;
}

// The object under this key, made if it is missing: before the member `before`, or at the end.
Value& objectIn(Value& object, std::string_view key, std::string_view before = {}) {
  if (Value* found = findIn(&object, key)) return *found;
  const auto at = std::ranges::find(object.members, before, &Member::key);
  return object.members.insert(at, newMember(key, Value::Type::Object, object))->value;
}

Value& withParts(Value& document) {
  objectIn(document, "passes", "outputs");
  objectIn(document, "parameters", "passes");
  objectIn(document, "view", "parameters");
  return document;
}

bool refersTo(const Value& value, std::string_view parameter) {
  if (value.isString()) {
    const size_t dollar = value.string.find('$');
    return dollar != std::string::npos && std::string_view(value.string).substr(dollar + 1) == parameter;
  }
  return std::ranges::any_of(value.members, [&](const Member& m) { return refersTo(m.value, parameter); });
}

// "near-field-$rays" is of the type "near-field".
bool isOf(std::string_view type, std::string_view name) {
  return type.starts_with(name) && (type.size() == name.size() || type[name.size()] == '-');
}

class ToVersion2 {
 public:
  explicit ToVersion2(Value& document)
      : document_(withParts(document)),
        view_(objectIn(document, "view")),
        parameters_(objectIn(document, "parameters")),
        passes_(objectIn(document, "passes")) {}

  std::vector<Change> run() {
    for (Member& pass : passes_.members) changePass(pass);
    for (size_t p = 0; p < passes_.members.size(); ++p) p += readMovedReservoirs(p);
    moveParametersToPasses();
    moveParametersToView();
    keepDiffuse();
    std::erase_if(document_.members, [](const Member& m) {
      const bool empty = m.value.isObject() && m.value.members.empty();
      return empty && (m.key == "parameters" || m.value.where.line == 0);
    });
    return std::move(changes_);
  }

 private:
  void say(const json::Position& where, std::string what) {
    changes_.push_back({where.line > 0 ? where : document_.where, std::move(what), where.line == 0});
  }

  void setView(const Member& member) {
    if (const Value* other = findIn(&view_, member.key)) {
      if (json::print(*other) != json::print(member.value))
        say(member.value.where,
            fmt::format("`{}` has several values, of which `view` keeps the first", member.key));
      return;
    }
    view_.members.push_back(member);
    say(member.value.where, fmt::format("`{}` belongs to the frame, under `view`", member.key));
  }

  // The value that a parameter of a pass has, if this file says it: that of "$name" is the default of `name`.
  const Value* valueOf(const Value& given) {
    if (!given.isString() || !given.string.starts_with('$') || given.string == kMaterialsOfScene)
      return &given;
    return findIn(&parameters_, std::string_view(given.string).substr(1));
  }

  void changePass(Member& pass) {
    Value* params = findIn(&pass.value, "params");
    const std::string type(textIn(&pass.value, "type"));
    for (const ToView& row : kToView) {
      const bool has = std::ranges::any_of(row.types, [&](auto name) { return isOf(type, name); });
      if (!type.empty() && !has) continue;
      const Value* given = findIn(params, row.parameter);
      if (!given && type == "antialias") setView(newNumber(row.parameter, kJitterOfAntialias, document_));
      if (row.parameter == "materials" && has) (given ? says_ : silent_) = true;
      if (given) moveToView(type.empty() ? pass.key : type, *params, row.parameter, *given);
    }
    if (params && params->members.empty()) removeFrom(pass.value, "params");
    if (textIn(&pass.value, "graph").empty()) return changeType(pass);
    if (Value* parameters = findIn(&pass.value, "parameters")) changeInstance(pass.value, *parameters);
  }

  // type: of the pass, or its name where the type is that of what this file extends.
  void moveToView(std::string_view type, Value& params, std::string_view name, const Value& given) {
    const Value* value = valueOf(given);
    const json::Position where = given.where;
    if (value && value != &given) handedOn_.insert(given.string.substr(1));
    const bool spares = name != "fovea_radius" || !isOf(type, "near-field") || !value || !value->isNumber() ||
                        value->real < kWholePicture;
    if (spares && value && !value->isNull() && value->string != kMaterialsOfScene)
      setView({std::string(name), *value, where});
    else
      say(where, fmt::format("passes have no `{}` of their own", name));
    removeFrom(params, name);
    if (!spares) params.members.push_back(newNumber("spacing", kFinestSpacing, document_));
  }

  void changeType(Member& pass) {
    Value* type = findIn(&pass.value, "type");
    if (!type || !type->isString()) return;
    for (const std::string_view name : kRayPasses) {
      if (!type->string.starts_with(name)) continue;
      const std::string_view end = std::string_view(type->string).substr(name.size());
      if (end != "-host" && end != "-device" && !end.starts_with("-$")) continue;
      say(type->where, fmt::format("`{}` is `{}`; --rays says where rays run", type->string, name));
      type->string = name;
      return;
    }
  }

  // Passes that reuse samples of other pixels had a second G-buffer. They read the samples of the previous frame, and its
  // surfaces, from a pass that moves both now. Returns the number of passes that are added before this one.
  size_t readMovedReservoirs(size_t index) {
    Member& pass = passes_.members[index];
    const std::string_view type = textIn(&pass.value, "type");
    if (!isOf(type, "reservoirs-visibility") && !isOf(type, "reservoirs-merge")) return 0;
    Value* params = findIn(&pass.value, "params");
    if (params) removeFrom(*params, "previous");
    if (params && params->members.empty()) removeFrom(pass.value, "params");
    Value* inputs = findIn(&pass.value, "inputs");
    Value *other = findIn(inputs, "other_gbuffer"), *samples = findIn(inputs, "others");
    if (!other || !samples) return 0;
    say(other->where, fmt::format("`{}` has no `other_gbuffer`: `reservoirs-motion` moves samples", type));
    const Member gbuffer = newText("previous", other->string, *inputs);
    const Member before = newText("samples", samples->string, *inputs);
    if (!gbuffer.value.string.ends_with("@previous")) {  // of the same frame
      removeFrom(*inputs, "other_gbuffer");
      return 0;
    }
    const std::string name =
        before.value.string.substr(0, before.value.string.find_first_of(".@")) + "-motion";
    samples->string = name + ".reservoirs";
    *std::ranges::find(inputs->members, "other_gbuffer", &Member::key) =
        newText("moved", name + ".moved", *inputs);
    if (findIn(&passes_, name)) return 0;
    Member motion = newMember(name, Value::Type::Object, passes_);
    motion.value.members.push_back(newText("type", "reservoirs-motion", motion.value));
    motion.value.members.push_back(newMember("inputs", Value::Type::Object, motion.value));
    motion.value.members.back().value.members = {gbuffer, before};
    passes_.members.insert(passes_.members.begin() + static_cast<ptrdiff_t>(index), std::move(motion));
    return 1;
  }

  bool choosesRays(const Member& parameter) {
    const Value* value = valueOf(parameter.value);
    return std::ranges::count(kRayParameters, parameter.key) != 0 && !(value && value->isNumber());
  }

  void changeInstance(Value& instance, Value& parameters) {
    std::erase_if(parameters.members, [&](const Member& given) {
      const bool toView = std::ranges::count(kToView, given.key, &ToView::parameter) != 0;
      if (!toView && !choosesRays(given)) return false;
      say(given.keyWhere, fmt::format("sub-graphs have no `{}` of their own", given.key));
      return true;
    });
    if (parameters.members.empty()) removeFrom(instance, "parameters");
  }

  void moveParametersToPasses() {
    const std::string_view base = textIn(&document_, "extends");
    if (!base.substr(base.rfind('/') + 1).starts_with("foveal")) return;
    for (const ToPass& row : kToPass) {
      const Value* given = findIn(&parameters_, row.parameter);
      if (!given) continue;
      say(given->where,
          fmt::format("`{}` is the parameter `{}` of pass `{}`", row.parameter, row.name, row.pass));
      if (given->isNull()) continue;
      Value& params = objectIn(objectIn(passes_, row.pass), "params");
      if (!findIn(&params, row.name)) params.members.push_back({std::string(row.name), *given, given->where});
    }
    for (const ToPass& row : kToPass) removeFrom(parameters_, row.parameter);
  }

  void moveParametersToView() {
    std::erase_if(parameters_.members, [&](const Member& parameter) {
      const bool toView = std::ranges::count(kToView, parameter.key, &ToView::parameter) != 0;
      const bool goes = toView || handedOn_.contains(parameter.key) || choosesRays(parameter);
      if (!goes || refersTo(passes_, parameter.key)) return false;
      if (toView && !parameter.value.isNull() && parameter.value.string != kMaterialsOfScene)
        setView(parameter);
      else
        say(parameter.keyWhere, fmt::format("graphs have no parameter `{}`", parameter.key));
      return true;
    });
  }

  // Passes that were not told of materials took diffuse ones, whatever the scene.
  void keepDiffuse() {
    if (!silent_ || says_ || findIn(&document_, "extends") || findIn(&document_, "inputs")) return;
    setView(newText("materials", std::string(kMaterialsOfPasses), document_));
  }

  Value& document_;
  // Its parts, made if they are missing, all of them before the first is referred to.
  Value &view_, &parameters_, &passes_;
  std::vector<Change> changes_;
  std::set<std::string, std::less<>> handedOn_;  // parameters that passes took for what belongs to the frame
  bool says_ = false, silent_ = false;  // whether passes that had `materials` were told of them, or not
};

}  // namespace

std::vector<Change> migrate(Value& document) {
  if (!document.isObject()) return {};
  const Value* version = document.find("version");
  if (version && (!version->isInt() || version->integer != 1)) return {};
  std::vector<Change> changes = ToVersion2(document).run();
  removeFrom(document, "version");
  const auto at = document.members.begin() + (document.find("$schema") == nullptr ? 0 : 1);
  document.members.insert(at, newNumber("version", kGraphVersion, document));
  return changes;
}

void migrateLoaded(Value& document, Diagnostics& diagnostics) {
  const Value* version = document.find("version");
  if (version && (!version->isInt() || version->integer < 1 || version->integer > kGraphVersion))
    return diagnostics.error(
        version->where.location(), "version",
        fmt::format("expected a version from 1 to {}, found {}", kGraphVersion, version->describe()),
        "take a fovea that knows this version");
  std::vector<Change> changes = migrate(document);
  std::erase_if(changes, [](const Change& change) { return change.isDefault; });
  if (changes.empty()) return;
  const std::string file = document.where.file ? *document.where.file : std::string("FILE");
  diagnostics.warning(changes.front().where.location(), {},
                      fmt::format("a graph of version 1, read as one of version {}: {}{}", kGraphVersion,
                                  changes.front().what, changes.size() > 1 ? ", and more" : ""),
                      fmt::format("`fovea migrate {}` rewrites it", file));
}

}  // namespace fovea::graph
