// Expressions over sizes and parameters: how they are put together and printed. Others evaluate them (evaluate.h).
#include <string>
#include <utility>
#include <vector>

#include "fovea/declaration.h"

namespace fovea::graph {

SizeExpr::SizeExpr(const SizeExpr& a, const SizeExpr& b, Op op) : terms_(a.terms_) {
  terms_.insert(terms_.end(), b.terms_.begin(), b.terms_.end());
  terms_.push_back({op, 0, {}});
}

namespace {

struct Printed {
  std::string text;
  int strength;  // 3 for a leaf or call, 2 for a product, 1 for a sum, 0 for a comparison
};

Printed printLeaf(const SizeExpr::Term& term) {
  using Op = SizeExpr::Op;
  switch (term.op) {
    case Op::Constant:
      return {std::to_string(term.constant), 3};
    case Op::ViewWidth:
      return {"view.width", 3};
    case Op::ViewHeight:
      return {"view.height", 3};
    case Op::PortWidth:
      return {term.name + ".width", 3};
    case Op::PortHeight:
      return {term.name + ".height", 3};
    case Op::PortLayers:
      return {term.name + ".layers", 3};
    case Op::PortCount:
      return {term.name + ".count", 3};
    case Op::Wired:
      return {"wired(" + term.name + ")", 3};
    case Op::Read:
      return {"read(" + term.name + ")", 3};
    case Op::ParameterIs:
      return {term.name + " == " + term.choice, 0};
    default:
      return {term.name, 3};
  }
}

Printed printOperator(SizeExpr::Op op, const Printed& a, const Printed& b) {
  using Op = SizeExpr::Op;
  auto wrap = [](const Printed& p, int needed) { return p.strength < needed ? "(" + p.text + ")" : p.text; };
  switch (op) {
    case Op::Add:
      return {wrap(a, 1) + " + " + wrap(b, 1), 1};
    case Op::Sub:
      return {wrap(a, 1) + " - " + wrap(b, 2), 1};
    case Op::Mul:
      return {wrap(a, 2) + " * " + wrap(b, 2), 2};
    case Op::Div:
      return {wrap(a, 2) + " / " + wrap(b, 3), 2};
    case Op::Min:
      return {"min(" + a.text + ", " + b.text + ")", 3};
    case Op::Same:
      return {"same(" + a.text + ", " + b.text + ")", 3};
    case Op::AtMost:
      return {wrap(a, 1) + " <= " + wrap(b, 1), 0};
    default:
      return {"max(" + a.text + ", " + b.text + ")", 3};
  }
}

}  // namespace

std::string SizeExpr::print() const {
  std::vector<Printed> stack;
  for (const Term& term : terms_) {
    if (term.op < Op::Add) {
      stack.push_back(printLeaf(term));
      continue;
    }
    const Printed b = std::move(stack.back());
    stack.pop_back();
    stack.back() = printOperator(term.op, stack.back(), b);
  }
  return stack.empty() ? std::string("1") : stack.back().text;
}

SizeExpr operator+(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Add}; }
SizeExpr operator-(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Sub}; }
SizeExpr operator*(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Mul}; }
SizeExpr ceilDiv(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Div}; }
SizeExpr min(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Min}; }
SizeExpr max(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Max}; }
SizeExpr viewWidth() { return {SizeExpr::Op::ViewWidth, std::string()}; }
SizeExpr viewHeight() { return {SizeExpr::Op::ViewHeight, std::string()}; }
SizeExpr parameter(std::string name) { return {SizeExpr::Op::Parameter, std::move(name)}; }
SizeExpr widthOf(std::string port) { return {SizeExpr::Op::PortWidth, std::move(port)}; }
SizeExpr heightOf(std::string port) { return {SizeExpr::Op::PortHeight, std::move(port)}; }
SizeExpr layersOf(std::string port) { return {SizeExpr::Op::PortLayers, std::move(port)}; }
SizeExpr countOf(std::string port) { return {SizeExpr::Op::PortCount, std::move(port)}; }
SizeExpr environment(std::string name) { return {SizeExpr::Op::Environment, std::move(name)}; }
SizeExpr wired(std::string port) { return {SizeExpr::Op::Wired, std::move(port)}; }
SizeExpr isRead(std::string path) { return {SizeExpr::Op::Read, std::move(path)}; }
SizeExpr is(std::string parameter, std::string choice) {
  return SizeExpr(
      std::vector<SizeExpr::Term>{{SizeExpr::Op::ParameterIs, 0, std::move(parameter), std::move(choice)}});
}
SizeExpr same(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::Same}; }
SizeExpr atMost(const SizeExpr& a, const SizeExpr& b) { return {a, b, SizeExpr::Op::AtMost}; }
SizeExpr operator!(const SizeExpr& a) { return SizeExpr(1) - a; }
SizeExpr operator&&(const SizeExpr& a, const SizeExpr& b) { return a * b; }
SizeExpr operator||(const SizeExpr& a, const SizeExpr& b) { return max(a, b); }

}  // namespace fovea::graph
