#include "framework/graph/pass/evaluate.h"

#include <algorithm>
#include <cmath>

namespace fovea::graph {

std::optional<int64_t> wholeNumber(const Parameters& parameters, std::string_view name) {
  const Value* value = parameters.find(name);
  if (!value) return std::nullopt;
  if (const int64_t* number = std::get_if<int64_t>(value)) return *number;
  if (const double* real = std::get_if<double>(value)) return static_cast<int64_t>(std::ceil(*real));
  if (const bool* flag = std::get_if<bool>(value)) return *flag;
  const std::string* chosen = std::get_if<std::string>(value);
  if (!chosen) return std::nullopt;
  const std::vector<std::string>& choices = parameters.findSpec(name)->choices;
  return std::find(choices.begin(), choices.end(), *chosen) - choices.begin();
}

bool holds(const SizeExpr& condition, const Parameters& parameters) {
  std::string why;
  const auto leaf = [&](const SizeExpr::Term& term) -> std::optional<int64_t> {
    switch (term.op) {
      case SizeExpr::Op::Constant:
        return term.constant;
      case SizeExpr::Op::Parameter:
        return wholeNumber(parameters, term.name);
      default:  // ParameterIs, as others were refused when the pass was registered
        return parameters.text(term.name) == term.choice;
    }
  };
  return evaluate(condition, why, leaf).value_or(1) != 0;
}

namespace {

// That size of a description or of a specification, whose members have the same names.
template <class Size, class Resource>
Size sizeOf(const Resource& resource, SizeExpr::Op what) {
  switch (what) {
    case SizeExpr::Op::PortWidth:
      return static_cast<Size>(resource.width);
    case SizeExpr::Op::PortHeight:
      return static_cast<Size>(resource.height);
    case SizeExpr::Op::PortLayers:
      return static_cast<Size>(resource.volume ? resource.depth : resource.layers);
    default:
      return static_cast<Size>(resource.count);
  }
}

}  // namespace

int64_t quantityOf(const ResourceDesc& desc, SizeExpr::Op what) { return sizeOf<int64_t>(desc, what); }

const SizeExpr& expressionOf(const ResourceSpec& spec, SizeExpr::Op what) {
  return sizeOf<const SizeExpr&>(spec, what);
}

bool applyOperator(SizeExpr::Op op, ExpressionStack& stack) {
  if (stack.size < 2) return false;
  const int64_t b = stack.values[--stack.size];
  int64_t& a = stack.values[stack.size - 1];
  switch (op) {
    case SizeExpr::Op::Add:
      return !__builtin_add_overflow(a, b, &a);
    case SizeExpr::Op::Sub:
      return !__builtin_sub_overflow(a, b, &a);
    case SizeExpr::Op::Mul:
      return !__builtin_mul_overflow(a, b, &a);
    case SizeExpr::Op::Div:
      if (b <= 0 || a < 0) return false;
      a = a / b + (a % b != 0);
      return true;
    case SizeExpr::Op::Min:
      a = std::min(a, b);
      return true;
    case SizeExpr::Op::Same:
      a = a == b;
      return true;
    case SizeExpr::Op::AtMost:
      a = a <= b;
      return true;
    default:
      a = std::max(a, b);
      return true;
  }
}

}  // namespace fovea::graph
