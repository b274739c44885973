#include "framework/graph/pass/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fovea/error.h"
#include "framework/gpu/format.h"

namespace fovea::graph {

namespace {

class Validator {
 public:
  Validator(const PassDeclaration& d, Diagnostics& found) : d_(d), found_(found) {}

  void run() {
    checkName(d_.type, "type", false);
    if (d_.doc.empty()) wrong("has no doc");
    std::set<std::string> names;
    for (const ParameterSpec& p : d_.parameters) {
      if (!names.insert(p.name).second) wrong(fmt::format("parameter `{}` is declared twice", p.name));
      path_ = "params." + p.name;
      checkParameter(p);
    }
    names.clear();
    for (const PortSpec& port : d_.ports) {
      if (!names.insert(port.name).second) wrong(fmt::format("port `{}` is declared twice", port.name));
      path_ = "ports." + port.name;
      checkPort(port);
    }
    path_.clear();
    names.clear();
    for (const CounterSpec& c : d_.counters)
      if (!names.insert(c.name).second) wrong(fmt::format("counter `{}` is declared twice", c.name));
    for (size_t i = 0; i < d_.requirements.size(); ++i) {
      path_ = fmt::format("requires[{}]", i);
      checkRequirement(d_.requirements[i]);
    }
    names.clear();
    for (const StepSpec& step : d_.steps) {
      if (!names.insert(step.name).second) wrong(fmt::format("step `{}` is declared twice", step.name));
      path_ = "steps." + step.name;
      checkStep(step);
    }
  }

 private:
  void wrong(const std::string& what) {
    found_.error(d_.placeOf(path_), d_.places ? path_ : "", fmt::format("pass type `{}`: {}", d_.type, what));
  }

  void checkName(const std::string& name, const char* what, bool snake) {
    const bool good =
        !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
        std::all_of(name.begin(), name.end(), [&](char c) {
          return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || (!snake && c == '-');
        });
    if (!good)
      wrong(fmt::format("{} name `{}` is not in lower case{}", what, name, snake ? " snake_case" : ""));
  }

  void checkParameter(const ParameterSpec& p) {
    using Type = ParameterSpec::Type;
    checkName(p.name, "parameter", true);
    if (p.doc.empty()) wrong(fmt::format("parameter `{}` has no doc", p.name));
    if (p.min > p.max) wrong(fmt::format("parameter `{}`: empty range {} to {}", p.name, p.min, p.max));
    const bool typed = (p.type == Type::Bool && std::holds_alternative<bool>(p.defaultValue)) ||
                       (p.type == Type::Int && std::holds_alternative<int64_t>(p.defaultValue)) ||
                       (p.type == Type::Real && std::holds_alternative<double>(p.defaultValue)) ||
                       ((p.type == Type::Choice || p.type == Type::Text) &&
                        std::holds_alternative<std::string>(p.defaultValue));
    if (!typed) return wrong(fmt::format("parameter `{}`: the default is of another type", p.name));
    if (p.type == Type::Int || p.type == Type::Real) {
      const double v = p.type == Type::Int ? static_cast<double>(std::get<int64_t>(p.defaultValue))
                                           : std::get<double>(p.defaultValue);
      if (!std::isfinite(v) || v < p.min || v > p.max)
        wrong(fmt::format("parameter `{}`: the default {} is outside {} to {}", p.name, v, p.min, p.max));
    }
    if (p.type == Type::Choice && std::find(p.choices.begin(), p.choices.end(),
                                            std::get<std::string>(p.defaultValue)) == p.choices.end())
      wrong(fmt::format("parameter `{}`: the default `{}` is none of its choices", p.name,
                        std::get<std::string>(p.defaultValue)));
  }

  void checkPort(const PortSpec& port) {
    checkName(port.name, "port", true);
    if (port.members.empty()) wrong(fmt::format("port `{}` has no members", port.name));
    if (port.bundle.empty() && (port.members.size() != 1 || !port.members[0].name.empty()))
      wrong(fmt::format("port `{}` is no bundle but has named members", port.name));
    const bool wired = port.direction == Direction::Input || port.direction == Direction::InOut;
    if (port.optional && port.direction != Direction::Input && port.direction != Direction::InOut)
      wrong(fmt::format("port `{}`: only inputs can be optional", port.name));
    checkCondition(port);
    if (wired && port.lifetime != Lifetime::Transient)
      wrong(fmt::format("port `{}`: an input lives as long as its producer says", port.name));
    std::set<std::string> names;
    for (const MemberSpec& m : port.members) {
      if (!port.bundle.empty()) checkName(m.name, "member", true);
      if (!names.insert(m.name).second) wrong(fmt::format("port `{}`: member `{}` twice", port.name, m.name));
      const std::string path = memberPath(port, m);
      if (!shaderNames_.insert(shaderName(path)).second)
        wrong(fmt::format("port `{}` has the same name in shaders as another", path));
      checkMember(port, m, path);
    }
  }

  void checkMember(const PortSpec& port, const MemberSpec& m, const std::string& path) {
    const ResourceSpec& r = m.resource;
    const bool image = r.kind == ResourceKind::Image;
    const uint32_t allowed = static_cast<uint32_t>(image ? kImageUsages : kBufferUsages);
    if (static_cast<uint32_t>(m.usage) & ~allowed)
      wrong(fmt::format("port `{}`: a usage that {} cannot have", path, image ? "an image" : "a buffer"));
    if (d_.kind == PassKind::Host && (static_cast<uint32_t>(m.usage) & ~static_cast<uint32_t>(kHostUsages)))
      wrong(fmt::format("port `{}`: a host pass only has HostRead and HostWrite", path));
    if (d_.kind != PassKind::Host && any(m.usage, kHostUsages))
      wrong(fmt::format("port `{}`: HostRead and HostWrite are for host passes", path));
    const bool attachment = any(m.usage, Usage::ColorAttachment | Usage::DepthAttachment);
    if (attachment && d_.kind == PassKind::Compute)
      wrong(fmt::format("port `{}`: a compute pass has no attachments", path));
    // A depth attachment that is an input is tested but not written.
    const Usage written = port.direction == Direction::Input
                              ? Usage(uint32_t(kWriteUsages) & ~uint32_t(Usage::DepthAttachment))
                              : kWriteUsages;
    if (port.direction == Direction::Input && any(m.usage, written))
      wrong(fmt::format("port `{}`: an input with a writing usage", path));
    if (port.direction != Direction::Input && !any(m.usage, kWriteUsages))
      wrong(fmt::format("port `{}`: nothing writes it; give it a writing usage", path));
    const gpu::FormatInfo* format = gpu::findFormat(r.format);
    if (image && r.format != VK_FORMAT_UNDEFINED && !format)
      wrong(fmt::format("port `{}`: VkFormat {} is not one of fovea's formats", path, int(r.format)));
    if (any(m.usage, Usage::DepthAttachment) && r.format != VK_FORMAT_UNDEFINED && !(format && format->depth))
      wrong(fmt::format("port `{}`: a depth attachment needs a depth format", path));
    const bool makes = port.direction == Direction::Output || port.direction == Direction::Scratch;
    if (image && makes && r.format == VK_FORMAT_UNDEFINED)
      wrong(fmt::format("port `{}`: an output needs a format", path));
    if (r.light > 0 && format && !gpu::holdsLight(r.format))
      wrong(fmt::format("port `{}`: light needs a format of 16- or 32-bit floats", path));
    if (image && r.volume && r.array) wrong(fmt::format("port `{}`: a volume has no layers", path));
    if (!image && r.element.empty()) wrong(fmt::format("port `{}`: a buffer needs an element type", path));
    if (!image && r.stride == 0) wrong(fmt::format("port `{}`: a buffer needs a stride", path));
    if (!makes) return;
    for (const SizeExpr* size : {&r.width, &r.height, &r.depth, &r.layers, &r.mips, &r.count})
      checkSize(*size, path);
  }

  void checkRequirement(const RequirementSpec& requirement) {
    using Op = SizeExpr::Op;
    if (requirement.message.empty()) wrong("a requirement does not say what is wrong without it");
    for (const SizeExpr::Term& term : requirement.condition.terms()) {
      if (term.op == Op::Constant || term.op == Op::ViewWidth || term.op == Op::ViewHeight ||
          term.op >= Op::Add)
        continue;
      const ParameterSpec* p = findParameter(d_.parameters, term.name);
      const bool known = term.op == Op::Parameter     ? p && p->type != ParameterSpec::Type::Text
                         : term.op == Op::ParameterIs ? p && std::ranges::count(p->choices, term.choice) > 0
                         : term.op == Op::Wired
                             ? isInput(d_.findPort(term.name))
                             : term.op <= Op::PortCount && findInput(term.name, term.op == Op::PortCount);
      if (!known)
        wrong(fmt::format("requirement `{}`: `{}` is no parameter, choice or size of an input",
                          requirement.condition.print(), term.name));
    }
  }

  static bool isInput(const PortSpec* port) {
    return port && (port->direction == Direction::Input || port->direction == Direction::InOut);
  }

  // The image or buffer that an input, "surface.position", stands for.
  const MemberSpec* findInput(const std::string& path, bool isBuffer) const {
    for (const PortSpec& port : d_.ports)
      for (const MemberSpec& m : port.members)
        if (isInput(&port) && memberPath(port, m) == path &&
            (m.resource.kind == ResourceKind::Buffer) == isBuffer)
          return &m;
    return nullptr;
  }

  // The parameter, if it is one that expressions can use.
  const ParameterSpec* countable(const std::string& name) const {
    using Type = ParameterSpec::Type;
    const ParameterSpec* p = findParameter(d_.parameters, name);
    const bool counts = p && (p->type == Type::Int || p->type == Type::Choice || p->type == Type::Bool);
    return counts ? p : nullptr;
  }

  void checkCondition(const PortSpec& port) {
    using Op = SizeExpr::Op;
    for (const SizeExpr::Term& term : port.condition.terms()) {
      const bool named = term.op == Op::Parameter || term.op == Op::ParameterIs;
      const ParameterSpec* p = named ? countable(term.name) : nullptr;
      const bool known = p && (term.op == Op::Parameter || std::find(p->choices.begin(), p->choices.end(),
                                                                     term.choice) != p->choices.end());
      if (term.op != Op::Constant && term.op < Op::Add && !known)
        wrong(
            fmt::format("port `{}`: the condition `{}` is not over whole-number parameters, choices or flags",
                        port.name, port.condition.print()));
    }
  }

  void checkSize(const SizeExpr& size, const std::string& path) {
    using Op = SizeExpr::Op;
    for (const SizeExpr::Term& term : size.terms()) {
      if (term.op == Op::Parameter) {
        if (!countable(term.name))
          wrong(fmt::format(
              "port `{}`: size `{}` is over `{}`, which is no whole-number parameter, choice or flag", path,
              size.print(), term.name));
      } else if (term.op >= Op::PortWidth && term.op <= Op::PortCount) {
        checkSizePort(size, term, path);
      } else if (term.op == Op::Wired) {
        if (!d_.findPort(term.name))
          wrong(fmt::format("port `{}`: size `{}` is over `{}`, which is no port", path, size.print(),
                            term.name));
      } else if (term.op == Op::Read || term.op == Op::ParameterIs) {
        wrong(fmt::format("port `{}`: size `{}` is over a condition, which only steps know", path,
                          size.print()));
      }
    }
  }

  void checkSizePort(const SizeExpr& size, const SizeExpr::Term& term, const std::string& path) {
    const size_t dot = term.name.find('.');
    const PortSpec* port = d_.findPort(std::string_view(term.name).substr(0, dot));
    const std::string memberName = dot == std::string::npos ? std::string() : term.name.substr(dot + 1);
    const MemberSpec* found = nullptr;
    if (port && (port->direction == Direction::Input || port->direction == Direction::InOut))
      for (const MemberSpec& m : port->members)
        if (m.name == memberName) found = &m;
    if (!found)
      return wrong(
          fmt::format("port `{}`: size `{}` is over `{}`, which is no input", path, size.print(), term.name));
    const bool wantsBuffer = term.op == SizeExpr::Op::PortCount;
    if (wantsBuffer != (found->resource.kind == ResourceKind::Buffer))
      wrong(fmt::format("port `{}`: size `{}` asks `{}` for what {} does not have", path, size.print(),
                        term.name, wantsBuffer ? "an image" : "a buffer"));
  }

  // The member that a step names; null after a report if there is none.
  const MemberSpec* stepPort(const StepSpec& step, const std::string& path) {
    const size_t dot = path.find('.');
    std::vector<std::string> known;
    for (const PortSpec& port : d_.ports)
      for (const MemberSpec& m : port.members) {
        const std::string name = memberPath(port, m);
        if (name == path) return &m;
        known.push_back(name);
        // The name of a whole bundle serves to ask whether it is wired.
        if (dot == std::string::npos && port.name == path) return &port.members[0];
      }
    const std::string nearest = nearestName(path, known);
    wrong(fmt::format("step `{}`: no port `{}`{}", step.name, path,
                      nearest.empty() ? "" : fmt::format("; did you mean `{}`?", nearest)));
    return nullptr;
  }

  // The member if a step may use it in this way; null after a report if not.
  const MemberSpec* checkTarget(const StepSpec& step, const std::string& path, ResourceKind kind, Usage usage,
                                const char* usageName) {
    const MemberSpec* m = stepPort(step, path);
    if (!m) return nullptr;
    if (m->resource.kind != kind)
      wrong(fmt::format("step `{}`: `{}` is {}", step.name, path,
                        kind == ResourceKind::Image ? "a buffer, not an image" : "an image, not a buffer"));
    else if (!any(m->usage, usage))
      wrong(fmt::format("step `{}`: port `{}` does not declare the usage {}", step.name, path, usageName));
    else
      return m;
    return nullptr;
  }

  void checkTiles(const StepSpec& step) {
    if (step.action != StepSpec::Action::Fullscreen)
      return wrong(
          fmt::format("step `{}`: only a fragment shader that writes images draws tiles", step.name));
    if (std::ranges::find(step.targets, step.tileMask) != step.targets.end())
      return wrong(fmt::format("step `{}`: `{}` says which tiles to draw, so the step cannot write it",
                               step.name, step.tileMask));
    const MemberSpec* m =
        checkTarget(step, step.tileMask, ResourceKind::Image, Usage::StorageRead, "StorageRead");
    if (m && (m->resource.format != VK_FORMAT_R8_UNORM || m->resource.array || m->resource.volume))
      wrong(fmt::format(
          "step `{}`: `{}` says which tiles to draw, so it has to be a flat image of the format r8",
          step.name, step.tileMask));
  }

  void checkStep(const StepSpec& step) {
    using Action = StepSpec::Action;
    if (step.name.empty()) wrong("a step has no name");
    for (const std::string& target : step.targets) {
      if (step.action == Action::Fullscreen)
        checkTarget(step, target, ResourceKind::Image, Usage::ColorAttachment, "ColorAttachment");
      else
        checkTarget(step, target, step.action == Action::Fill ? ResourceKind::Buffer : ResourceKind::Image,
                    Usage::TransferWrite, "TransferWrite");
    }
    if (step.action == Action::Copy)
      checkTarget(step, step.source, ResourceKind::Image, Usage::TransferRead, "TransferRead");
    if (!step.tileMask.empty()) checkTiles(step);
    if (step.sizing == StepSpec::Size::Indirect)
      checkTarget(step, step.sizePort, ResourceKind::Buffer, Usage::Indirect, "Indirect");
    if (step.sizing == StepSpec::Size::Over) stepPort(step, step.sizePort);
    checkExpression(step, step.condition);
    for (const auto& [name, value] : step.defines) checkExpression(step, value);
    for (const auto& [name, value] : step.constants) checkExpression(step, value);
    for (const SizeExpr& size : step.size) checkExpression(step, size);
  }

  void checkExpression(const StepSpec& step, const SizeExpr& expression) {
    using Op = SizeExpr::Op;
    for (const SizeExpr::Term& term : expression.terms()) {
      const auto refuse = [&](const char* why) {
        wrong(fmt::format("step `{}`: `{}` {}", step.name, expression.print(), why));
      };
      if (term.op == Op::ViewWidth || term.op == Op::ViewHeight || term.op == Op::Environment)
        refuse("is over something that only sizes of ports know");
      if ((term.op >= Op::PortWidth && term.op <= Op::PortCount) || term.op == Op::Wired ||
          term.op == Op::Read)
        stepPort(step, term.name);
      if (term.op != Op::Parameter && term.op != Op::ParameterIs) continue;
      const ParameterSpec* p = countable(term.name);
      if (!p)
        refuse("is over no whole-number parameter, choice or flag");
      else if (term.op == Op::ParameterIs &&
               std::find(p->choices.begin(), p->choices.end(), term.choice) == p->choices.end())
        refuse("compares with something that is none of the choices");
    }
  }

  const PassDeclaration& d_;
  Diagnostics& found_;
  std::string path_;  // of what is being checked, as PassDeclaration::places knows it
  std::set<std::string> shaderNames_;
};

}  // namespace

void validateDeclaration(const PassDeclaration& declaration, Diagnostics& diagnostics) {
  Validator(declaration, diagnostics).run();
}

void validateDeclaration(const PassDeclaration& declaration) {
  Diagnostics found;
  validateDeclaration(declaration, found);
  found.throwIfErrors(ExitCode::Internal);
}

}  // namespace fovea::graph
