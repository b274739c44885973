// Expressions as text, for passes that are declared in files: "view.width / 2", "min(radius * 2 + 1, 9)",
// "wired(direct) && strategy == area".
#pragma once

#include <string>
#include <string_view>

#include "fovea/declaration.h"

namespace fovea::graph {

struct ExpressionError {
  std::string message;  // empty if the text is an expression
  size_t column = 0;    // from 0, in the text
};

// Grammar, weakest first:  a || b   a && b   a <= b, name == choice, name != choice   a + b, a - b   a * b, a / b (rounds up)
// !a   number, parameter, view.width, view.height, view.PARAMETER, scene.NAME, PORT.width (height, layers, count), min(a, b),
// max(a, b), same(a, b), wired(PORT), read(PORT), (a). Returns 1 and fills `error` if the text is not an expression.
SizeExpr parseExpression(std::string_view text, ExpressionError& error);

}  // namespace fovea::graph
