// The values of expressions, when a graph is bound and when its steps are planned.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/declaration.h"
#include "fovea/graph.h"

namespace fovea::graph {

// A whole number; a real one is rounded up, a flag counts as 0 or 1, a choice as its index. Nothing for texts and unknown
// names.
std::optional<int64_t> wholeNumber(const Parameters& parameters, std::string_view name);

// Whether a condition over parameters alone is not 0.
bool holds(const SizeExpr& condition, const Parameters& parameters);

// PortWidth, PortHeight, PortLayers (the depth of a volume) or PortCount of a resource.
int64_t quantityOf(const ResourceDesc& desc, SizeExpr::Op what);
// The expression of that size.
const SizeExpr& expressionOf(const ResourceSpec& spec, SizeExpr::Op what);

// Operands of an expression that is being evaluated.
struct ExpressionStack {
  int64_t values[64];
  int size = 0;
};

// Replaces the two topmost values by their result. False on overflow, division by zero, or if there are no two.
bool applyOperator(SizeExpr::Op op, ExpressionStack& stack);

// `leaf` returns the value of a term that is no operator, or nothing. Nothing and the reason in `why` if an expression
// has no value; `why` stays empty if a leaf has none.
template <class Leaf>
std::optional<int64_t> evaluate(const SizeExpr& expression, std::string& why, const Leaf& leaf) {
  if (expression.terms().size() == 1) return leaf(expression.terms()[0]);
  ExpressionStack stack;
  for (const SizeExpr::Term& term : expression.terms()) {
    if (term.op >= SizeExpr::Op::Add) {
      if (applyOperator(term.op, stack)) continue;
      why = "overflows or divides by zero";
      return std::nullopt;
    }
    if (stack.size == 64) {
      why = "is too long an expression";
      return std::nullopt;
    }
    const std::optional<int64_t> value = leaf(term);
    if (!value) return std::nullopt;
    stack.values[stack.size++] = *value;
  }
  return stack.values[0];
}

}  // namespace fovea::graph
