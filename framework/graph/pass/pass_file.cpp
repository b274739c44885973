#include "framework/graph/pass/pass_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "framework/gpu/format.h"
#include "framework/graph/pass/derive.h"
#include "framework/graph/pass/expression.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph {
namespace {

namespace fs = std::filesystem;
using json::Member;
using json::ObjectReader;

constexpr std::string_view kEnding = ".pass.json";

struct UsageName {
  const char* name;
  Usage usage;
};
constexpr UsageName kUsages[] = {{"sampled", Usage::Sampled},
                                 {"storage_read", Usage::StorageRead},
                                 {"storage_write", Usage::StorageWrite},
                                 {"color_attachment", Usage::ColorAttachment},
                                 {"uniform", Usage::Uniform},
                                 {"texel_read", Usage::TexelRead},
                                 {"indirect", Usage::Indirect},
                                 {"transfer_read", Usage::TransferRead},
                                 {"transfer_write", Usage::TransferWrite}};

class Reader {
 public:
  Reader(const fs::path& file, Diagnostics& diagnostics)
      : file_(file),
        diagnostics_(diagnostics),
        places_(std::make_shared<std::map<std::string, SourceLocation>>()) {}

  PassDeclaration read(const json::Value& document, PassKind kind) {
    const std::string name = file_.filename().string();
    PassDeclaration d(name.substr(0, name.size() - kEnding.size()), "", kind);
    ObjectReader reader(document, "", diagnostics_);
    if (!document.isObject()) return d;
    places_->emplace("", document.where.location());
    reader.text("$schema");
    if (const json::Value* doc = reader.require("doc")) readDoc(d, *doc);
    d.usesView = reader.boolean("view", false);
    d.tracesRays = reader.boolean("rays", false);
    readPorts(d, reader.object("inputs"), "inputs", Direction::Input);
    readPorts(d, reader.object("updated"), "updated", Direction::InOut);
    readPorts(d, reader.object("outputs"), "outputs", Direction::Output);
    readPorts(d, reader.object("scratch"), "scratch", Direction::Scratch);
    if (const json::Value* params = reader.object("params"))
      for (const Member& m : params->members) readParameter(d, m);
    if (const json::Value* counters = reader.object("counters"))
      for (const Member& m : counters->members) readCounter(d, m);
    if (const json::Value* requirements = reader.array("requires")) readRequirements(d, *requirements);
    if (kind != PassKind::Host)
      if (const json::Value* steps = reader.require("steps")) readSteps(d, *steps);
    reader.finish();
    d.places = places_;
    if (kind != PassKind::Host) deriveKind(d);
    deriveUsages(d);
    return d;
  }

 private:
  void error(const json::Position& where, const std::string& path, std::string message,
             std::string remedy = {}) {
    diagnostics_.error(where.location(), path, std::move(message), std::move(remedy));
  }

  void readDoc(PassDeclaration& d, const json::Value& doc) {
    d.doc = doc.string;
    if (!doc.isString()) error(doc.where, "doc", fmt::format("expected a text, found {}", doc.describe()));
  }

  void place(const std::string& path, const json::Position& where) {
    places_->emplace(path, where.location());
  }

  SizeExpr expression(const json::Value& value, const std::string& path) {
    if (value.isInt()) return value.integer;
    if (value.isBool()) return value.boolean ? 1 : 0;
    if (!value.isString()) {
      error(value.where, path,
            fmt::format("expected a whole number or an expression such as \"view.width / 2\", found {}",
                        value.describe()));
      return 1;
    }
    ExpressionError wrong;
    SizeExpr parsed = parseExpression(value.string, wrong);
    if (wrong.message.empty()) return parsed;
    json::Position where = value.where;
    where.column += 1 + static_cast<int>(wrong.column);  // after the quote
    error(where, path, fmt::format("`{}`: {}", value.string, wrong.message));
    return 1;
  }

  SizeExpr expressionAt(ObjectReader& reader, const char* key, SizeExpr fallback) {
    const json::Value* value = reader.find(key);
    return value ? expression(*value, reader.pathOf(key)) : std::move(fallback);
  }

  // ---- Ports -------------------------------------------------------------------------------------------

  void readPorts(PassDeclaration& d, const json::Value* ports, const char* section, Direction direction) {
    if (!ports) return;
    for (const Member& m : ports->members) {
      PortSpec port;
      port.name = m.key;
      port.direction = direction;
      const std::string path = json::joinPath(section, m.key);
      place("ports." + m.key, m.keyWhere);
      if (m.value.isString()) {  // an image, of which the text is the documentation
        port.doc = m.value.string;
        port.members.push_back(member("", image2D(), Usage::None));
      } else {
        readPort(port, m, path);
      }
      d.ports.push_back(std::move(port));
    }
  }

  void readPort(PortSpec& port, const Member& m, const std::string& path) {
    ObjectReader reader(m.value, path, diagnostics_);
    if (!m.value.isObject()) return port.members.push_back(member("", image2D(), Usage::None));
    port.doc = reader.text("doc");
    if (port.direction != Direction::Output && port.direction != Direction::Scratch) {
      if (reader.has("when")) port.when(expressionAt(reader, "when", 1));
      port.optional = reader.boolean("optional", port.optional);
    }
    if (port.direction == Direction::Output || port.direction == Direction::Scratch) {
      const std::string keep = reader.choice("keep", "frame", {"frame", "view", "scene"});
      port.lifetime = keep == "view"    ? Lifetime::View
                      : keep == "scene" ? Lifetime::Scene
                                        : Lifetime::Transient;
    }
    if (reader.has("bundle")) {
      port.bundle = reader.text("bundle");
      readMembers(port, reader, path);
    } else {
      port.members.push_back(readMember("", reader));
    }
    reader.finish();
  }

  // Names alone stand for images of any format.
  void readMembers(PortSpec& port, ObjectReader& reader, const std::string& path) {
    const json::Value* members = reader.require("members");
    if (!members) return;
    if (members->isArray()) {
      for (const json::Value& name : members->items) {
        if (name.isString())
          port.members.push_back(member(name.string, image2D(), Usage::None));
        else
          error(name.where, path + ".members",
                fmt::format("expected the name of a member, found {}", name.describe()));
      }
      return;
    }
    if (!reader.object("members")) return;
    for (const Member& m : members->members) {
      ObjectReader memberReader(m.value, path + ".members." + m.key, diagnostics_);
      if (!m.value.isObject()) continue;
      MemberSpec spec = readMember(m.key, memberReader);
      spec.doc = memberReader.text("doc");
      memberReader.finish();
      port.members.push_back(std::move(spec));
    }
  }

  MemberSpec readMember(const std::string& name, ObjectReader& reader) {
    ResourceSpec r = image2D();
    if (reader.has("element")) {
      r = buffer(reader.text("element"), static_cast<uint32_t>(reader.integer("stride", 4, 1, 1 << 20)),
                 expressionAt(reader, "count", 1));
    } else {
      r.format = readFormat(reader);
      r.light = reader.boolean("light", false) ? 1 : 0;
      r.volume = reader.has("depth");
      r.array = reader.has("layers");
      r.width = expressionAt(reader, "width", viewWidth());
      r.height = expressionAt(reader, "height", viewHeight());
      r.depth = expressionAt(reader, "depth", 1);
      r.layers = expressionAt(reader, "layers", 1);
      r.mips = expressionAt(reader, "mips", 1);
    }
    return member(name, std::move(r), readUsage(reader));
  }

  VkFormat readFormat(ObjectReader& reader) {
    const json::Value* value = reader.find("format");
    if (!value) return VK_FORMAT_UNDEFINED;
    const VkFormat format = value->isString() ? gpu::formatFromName(value->string) : VK_FORMAT_UNDEFINED;
    if (format != VK_FORMAT_UNDEFINED) return format;
    std::vector<std::string> names;
    for (const gpu::FormatInfo& info : gpu::formats()) names.emplace_back(info.name);
    const std::string nearest = value->isString() ? nearestName(value->string, names) : "";
    error(value->where, reader.pathOf("format"), fmt::format("no texel format: {}", value->describe()),
          nearest.empty() ? "" : fmt::format("did you mean `{}`?", nearest));
    return format;
  }

  Usage readUsage(ObjectReader& reader) {
    Usage usage = Usage::None;
    const json::Value* list = reader.array("usage");
    if (!list) return usage;
    for (const json::Value& item : list->items) {
      const auto* known = std::find_if(std::begin(kUsages), std::end(kUsages), [&](const UsageName& u) {
        return item.isString() && item.string == u.name;
      });
      if (known != std::end(kUsages))
        usage = usage | known->usage;
      else
        error(item.where, reader.pathOf("usage"), fmt::format("no usage: {}", item.describe()),
              fmt::format("there are {}", usageNames()));
    }
    return usage;
  }

  static std::string usageNames() {
    std::string names;
    for (const UsageName& u : kUsages) names += fmt::format("{}{}", names.empty() ? "" : ", ", u.name);
    return names;
  }

  // ---- Parameters and counters -------------------------------------------------------------------------

  void readParameter(PassDeclaration& d, const Member& m) {
    const std::string path = json::joinPath("params", m.key);
    place(path, m.keyWhere);
    ObjectReader reader(m.value, path, diagnostics_);
    if (!m.value.isObject()) return;
    ParameterSpec spec;
    spec.name = m.key;
    spec.doc = reader.text("doc");
    spec.unit = reader.text("unit");
    const json::Value* value = reader.require("default");
    if (const json::Value* choices = reader.array("choices")) {
      spec.type = ParameterSpec::Type::Choice;
      for (const json::Value& c : choices->items) {
        if (!c.isString())
          error(c.where, path + ".choices", fmt::format("expected a text, found {}", c.describe()));
        else if (std::find(spec.choices.begin(), spec.choices.end(), c.string) != spec.choices.end())
          error(c.where, path + ".choices", fmt::format("the choice `{}` is there twice", c.string));
        else
          spec.choices.push_back(c.string);
      }
    }
    if (value) readDefault(spec, *value, path);
    if (spec.type == ParameterSpec::Type::Int || spec.type == ParameterSpec::Type::Real) {
      spec.min = reader.number("min", spec.min);
      spec.max = reader.number("max", spec.max);
    }
    reader.finish();
    if (value) d.parameters.push_back(std::move(spec));
  }

  void readDefault(ParameterSpec& spec, const json::Value& value, const std::string& path) {
    using Type = ParameterSpec::Type;
    spec.defaultValue = value.string;
    if (value.isString()) {
      if (spec.type != Type::Choice) spec.type = Type::Text;
    } else if (spec.type == Type::Choice || !(value.isBool() || value.isNumber())) {
      error(value.where, path + ".default",
            fmt::format("expected {}, found {}",
                        spec.type == Type::Choice ? "one of the choices" : "true, false, a number or a text",
                        value.describe()));
    } else if (value.isBool()) {
      spec.type = Type::Bool;
      spec.defaultValue = value.boolean;
    } else if (value.type == json::Value::Type::Int) {  // the spelling decides: 1.0 declares a real parameter
      spec.type = Type::Int;
      spec.defaultValue = value.integer;
    } else {
      spec.type = Type::Real;
      spec.defaultValue = value.real;
    }
  }

  void readCounter(PassDeclaration& d, const Member& m) {
    if (m.value.isString())
      d.counter(m.key, m.value.string);
    else
      error(m.value.where, json::joinPath("counters", m.key),
            fmt::format("expected the counter's documentation, found {}", m.value.describe()));
  }

  void readRequirements(PassDeclaration& d, const json::Value& requirements) {
    for (size_t i = 0; i < requirements.items.size(); ++i) {
      const json::Value& item = requirements.items[i];
      const std::string path = fmt::format("requires[{}]", i);
      place(path, item.where);
      ObjectReader reader(item, path, diagnostics_);
      if (!item.isObject()) continue;
      reader.require("condition");
      reader.require("otherwise");
      SizeExpr condition = expressionAt(reader, "condition", 1);
      d.require(std::move(condition), reader.text("otherwise"), reader.text("remedy"));
      reader.finish();
    }
  }

  // ---- Steps -------------------------------------------------------------------------------------------

  void readSteps(PassDeclaration& d, const json::Value& steps) {
    if (!steps.isArray())
      return error(steps.where, "steps", fmt::format("expected an array, found {}", steps.describe()));
    for (size_t i = 0; i < steps.items.size(); ++i) {
      const json::Value& item = steps.items[i];
      const std::string path = fmt::format("steps[{}]", i);
      ObjectReader reader(item, path, diagnostics_);
      if (!item.isObject()) continue;
      const size_t before = d.steps.size();
      readStep(d, reader, item);
      reader.finish();
      if (d.steps.size() > before) place("steps." + d.steps.back().name, item.where);
    }
    if (steps.items.empty()) error(steps.where, "steps", "a pass needs at least one step");
  }

  void readStep(PassDeclaration& d, ObjectReader& reader, const json::Value& item) {
    StepSpec* step = nullptr;
    if (reader.has("shader"))
      step = readKernel(d, reader);
    else if (reader.has("fill"))
      step = &d.fill(reader.text("fill"), word(reader));
    else if (reader.has("clear"))
      step = &d.clear(reader.text("clear"), word(reader));
    else if (reader.has("copy"))
      step = readCopy(d, reader);
    else
      error(item.where, reader.path(), "a step needs a `shader`, `fill`, `clear` or `copy`");
    if (!step) return;
    if (reader.has("name")) step->name = reader.text("name");
    step->tiles(reader.text("tiles"));
    step->condition = expressionAt(reader, "when", 1);
    step->together = reader.boolean("together", false);
  }

  static uint32_t word(ObjectReader& reader) {
    return static_cast<uint32_t>(reader.integer("word", 0, 0, 0xffffffffll));
  }

  static StepSpec* readCopy(PassDeclaration& d, ObjectReader& reader) {
    const std::string from = reader.text("copy");
    reader.require("to");
    return &d.copy(from, reader.text("to"));
  }

  StepSpec* readKernel(PassDeclaration& d, ObjectReader& reader) {
    const std::string shader = reader.text("shader"),
                      file = (fs::absolute(file_).parent_path() / shader).lexically_normal().string();
    if (reader.has("colors")) {
      std::vector<std::string> images;
      if (const json::Value* colors = reader.array("colors"))
        for (const json::Value& c : colors->items) images.push_back(c.string);
      if (!shader.ends_with(".frag")) wrongEnding(reader, shader, ".frag", "with `colors`");
      StepSpec& step = d.fullscreen(file, std::move(images));
      readDefines(step, reader);
      return &step;
    }
    if (!shader.ends_with(".comp")) wrongEnding(reader, shader, ".comp", "without `colors`");
    StepSpec& step = d.step(file);
    readDefines(step, reader);
    readSize(step, reader);
    return &step;
  }

  void wrongEnding(ObjectReader& reader, const std::string& shader, const char* ending, const char* why) {
    error(reader.find("shader")->where, reader.pathOf("shader"),
          fmt::format("the shader of a step {} ends in `{}`, not `{}`", why, ending, shader));
  }

  static bool isMacro(std::string_view name) {
    const auto within = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
           std::all_of(name.begin(), name.end(), within);
  }

  void readDefines(StepSpec& step, ObjectReader& reader) {
    if (const json::Value* defines = reader.object("define"))
      for (const Member& m : defines->members) {
        if (!isMacro(m.key))
          error(m.keyWhere, reader.pathOf("define"), fmt::format("`{}` is no name for a macro", m.key),
                "letters, digits and _, not beginning with a digit");
        step.define(m.key, expression(m.value, reader.pathOf("define") + "." + m.key));
      }
    if (const json::Value* constants = reader.object("constant"))
      for (const Member& m : constants->members)
        step.constants.emplace_back(m.key, expression(m.value, reader.pathOf("constant") + "." + m.key));
  }

  void readSize(StepSpec& step, ObjectReader& reader) {
    if (reader.has("over")) {
      step.over(reader.text("over"));
    } else if (reader.has("indirect")) {
      const std::string buffer = reader.text("indirect");
      step.indirect(buffer, static_cast<uint64_t>(reader.integer("offset", 0, 0, int64_t(1) << 40)));
    } else if (reader.has("groups") || reader.has("threads")) {
      const bool groups = reader.has("groups");
      const json::Value* list = reader.array(groups ? "groups" : "threads");
      if (list && (list->items.empty() || list->items.size() > 3))
        error(list->where, reader.path(), "a size has one to three numbers, along x, y and z");
      SizeExpr size[3];
      for (size_t i = 0; list && i < std::min<size_t>(3, list->items.size()); ++i)
        size[i] = expression(list->items[i], reader.path());
      if (groups)
        step.groups(size[0], size[1], size[2]);
      else
        step.threads(size[0], size[1], size[2]);
    } else {
      error(reader.value().where, reader.path(), "a compute step needs a size",
            "give it `over`, `threads`, `groups` or `indirect`");
    }
  }

  const fs::path& file_;
  Diagnostics& diagnostics_;
  std::shared_ptr<std::map<std::string, SourceLocation>> places_;
};

}  // namespace

PassDeclaration readHostPass(const json::Value& document, const std::string& type, Diagnostics& diagnostics) {
  const fs::path file = type + std::string(kEnding);
  PassDeclaration d = Reader(file, diagnostics).read(document, PassKind::Host);
  if (!diagnostics.hasErrors()) validateDeclaration(d, diagnostics);
  return d;
}

PassDeclaration readPassFile(const json::Value& document, const fs::path& file, Diagnostics& diagnostics) {
  PassDeclaration d = Reader(file, diagnostics).read(document, PassKind::Compute);
  if (!diagnostics.hasErrors()) validateDeclaration(d, diagnostics);
  return d;
}

PassDeclaration loadPassFile(const fs::path& file) {
  Diagnostics diagnostics;
  const json::Value document = json::parseFile(file);
  PassDeclaration d = readPassFile(document, file, diagnostics);
  diagnostics.throwIfErrors();
  return d;
}

std::vector<fs::path> findPassFiles(const fs::path& folder) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed))
    throw Error(ExitCode::BadInput, fmt::format("there is no folder of passes {}", folder.string()));
  std::map<std::string, fs::path> files;  // by the name of the type
  const auto add = [&](const fs::path& file) {
    const auto [other, isNew] = files.emplace(file.filename().string(), file);
    if (!isNew)
      throw Error(ExitCode::BadInput,
                  fmt::format("{} and {} declare one pass type", other->second.string(), file.string()),
                  "rename or remove one of them");
  };
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file(failed) && name.ends_with(kEnding)) add(entry.path());
    const fs::path inside = entry.path() / (name + std::string(kEnding));
    if (entry.is_directory(failed) && fs::is_regular_file(inside, failed)) add(inside);
  }
  std::vector<fs::path> list;
  for (const auto& [name, file] : files) list.push_back(file);
  return list;
}

}  // namespace fovea::graph
