#include "framework/graph/pass/expression.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>

namespace fovea::graph {
namespace {

// Deeper nesting is refused, so that hostile text cannot exhaust the stack.
constexpr int kMaxDepth = 32;

class Parser {
 public:
  Parser(std::string_view text, ExpressionError& error) : text_(text), error_(error) {}

  SizeExpr run() {
    SizeExpr value = either();
    skipSpace();
    if (at_ < text_.size()) fail(fmt::format("unexpected `{}`", text_.substr(at_, 1)));
    return error_.message.empty() ? value : SizeExpr(1);
  }

 private:
  void skipSpace() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  void fail(std::string message) {
    if (error_.message.empty()) error_ = {std::move(message), at_};
    at_ = text_.size();
  }

  bool take(std::string_view token) {
    skipSpace();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }

  void expect(std::string_view token) {
    if (!take(token)) fail(fmt::format("expected `{}`", token));
  }

  SizeExpr either() {
    SizeExpr value = all();
    while (take("||")) value = value || all();
    return value;
  }

  SizeExpr all() {
    SizeExpr value = comparison();
    while (take("&&")) value = value && comparison();
    return value;
  }

  SizeExpr comparison() {
    SizeExpr value = sum();
    return take("<=") ? atMost(value, sum()) : value;
  }

  SizeExpr sum() {
    SizeExpr value = product();
    while (true) {
      if (take("+"))
        value = value + product();
      else if (take("-"))
        value = value - product();
      else
        return value;
    }
  }

  SizeExpr product() {
    SizeExpr value = leaf();
    while (true) {
      if (take("*"))
        value = value * leaf();
      else if (take("/"))
        value = ceilDiv(value, leaf());
      else
        return value;
    }
  }

  SizeExpr leaf() {
    if (++depth_ > kMaxDepth) fail("the expression is nested too deeply");
    skipSpace();
    SizeExpr value = 1;
    if (at_ >= text_.size()) {
      fail("the expression ends where a value is expected");
    } else if (take("!")) {
      value = !leaf();
    } else if (take("(")) {
      value = either();
      expect(")");
    } else if (std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) {
      value = number();
    } else {
      value = named(word());
    }
    --depth_;
    return value;
  }

  SizeExpr number() {
    int64_t value = 0;
    const auto [end, wrong] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (wrong != std::errc() || value > int64_t(1) << 40) {
      fail("the number is too large");
      return 1;
    }
    at_ = static_cast<size_t>(end - text_.data());
    return value;
  }

  std::string word() {
    skipSpace();
    const size_t begin = at_;
    const auto belongs = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    };
    while (at_ < text_.size() && belongs(text_[at_])) ++at_;
    if (at_ == begin)
      fail(at_ < text_.size() ? fmt::format("unexpected `{}`", text_[at_])
                              : "the expression ends where a value is expected");
    return std::string(text_.substr(begin, at_ - begin));
  }

  // The name of a choice may hold hyphens: importance-area.
  std::string choice() {
    std::string name = word();
    while (at_ < text_.size() && text_[at_] == '-') {
      ++at_;
      name += '-' + word();
    }
    return name;
  }

  SizeExpr named(const std::string& name) {
    if (!error_.message.empty()) return 1;
    if (take("(")) return call(name);
    if (take("==")) return is(name, choice());
    if (take("!=")) return !is(name, choice());
    if (name == "view.width") return viewWidth();
    if (name == "view.height") return viewHeight();
    if (name.starts_with("scene.")) return environment(name);
    if (name.starts_with(kViewPrefix)) return parameter(name);
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos) return parameter(name);
    const std::string port = name.substr(0, dot), what = name.substr(dot + 1);
    if (what == "width") return widthOf(port);
    if (what == "height") return heightOf(port);
    if (what == "layers") return layersOf(port);
    if (what == "count") return countOf(port);
    fail(fmt::format("`{}` has no `{}`; a port has width, height, layers or count", port, what));
    return 1;
  }

  SizeExpr call(const std::string& function) {
    if (function == "wired" || function == "read") {
      const std::string port = word();
      expect(")");
      return function == "wired" ? wired(port) : isRead(port);
    }
    if (function != "min" && function != "max" && function != "same") {
      fail(fmt::format("there is no function `{}`; there are min, max, same, wired and read", function));
      return 1;
    }
    const SizeExpr a = either();
    expect(",");
    const SizeExpr b = either();
    expect(")");
    return function == "min" ? min(a, b) : function == "max" ? max(a, b) : same(a, b);
  }

  std::string_view text_;
  ExpressionError& error_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

SizeExpr parseExpression(std::string_view text, ExpressionError& error) { return Parser(text, error).run(); }

}  // namespace fovea::graph
