#include "framework/graph/report/schema.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/gpu/format.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/pass/validate.h"

namespace fovea::graph {
namespace {

using Json = nlohmann::ordered_json;

// "$name" refers to a graph parameter wherever a value is allowed; null removes what `extends` brought in.
Json orParameter(Json value) {
  return {{"anyOf",
           Json::array({std::move(value), {{"type", "string"}, {"pattern", "^\\$"}}, {{"type", "null"}}})}};
}

Json orNull(const char* type) { return {{"type", Json::array({type, "null"})}}; }

Json parameterSchema(const ParameterSpec& spec) {
  Json value = Json::object(), fallback;
  switch (spec.type) {
    case ParameterSpec::Type::Bool:
      value["type"] = "boolean";
      fallback = std::get<bool>(spec.defaultValue);
      break;
    case ParameterSpec::Type::Int:
      value["type"] = "integer";
      fallback = std::get<int64_t>(spec.defaultValue);
      break;
    case ParameterSpec::Type::Real:
      value["type"] = "number";
      fallback = std::get<double>(spec.defaultValue);
      break;
    case ParameterSpec::Type::Choice:
      value["enum"] = spec.choices;
      fallback = std::get<std::string>(spec.defaultValue);
      break;
    case ParameterSpec::Type::Text:
      value["type"] = "string";
      fallback = std::get<std::string>(spec.defaultValue);
      break;
  }
  auto bound = [&](const char* key, double limit) {
    if (!std::isfinite(limit)) return;
    if (spec.type == ParameterSpec::Type::Int)
      value[key] = static_cast<int64_t>(limit);
    else
      value[key] = limit;
  };
  bound("minimum", spec.min);
  bound("maximum", spec.max);
  Json schema = orParameter(std::move(value));
  schema["description"] = spec.unit.empty() ? spec.doc : fmt::format("{} [{}]", spec.doc, spec.unit);
  schema["default"] = std::move(fallback);
  return schema;
}

std::string describePort(const PortSpec& port) {
  const ResourceSpec& r = port.members[0].resource;
  std::string what;
  if (!port.bundle.empty()) {
    what = fmt::format("bundle {}:", port.bundle);
    for (const MemberSpec& m : port.members) what += " " + m.name;
  } else if (r.kind == ResourceKind::Buffer) {
    what = fmt::format("buffer of {}, {} bytes each", r.element, r.stride);
  } else {
    what = r.volume ? "3D image" : r.array ? "image array" : "image";
    for (const gpu::FormatInfo& info : gpu::formats())
      if (info.format == r.format) what += fmt::format(" {}", info.name);
  }
  return fmt::format("{} ({}{})", port.doc, what, port.optional ? ", optional" : "");
}

Json typeSchema(const PassDeclaration& d) {
  Json inputs{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json params = inputs;
  std::string outputs;
  for (const PortSpec& port : d.ports) {
    if (port.direction == Direction::Output || port.direction == Direction::InOut)
      outputs += fmt::format("\n  {}: {}", port.name, describePort(port));
    if (port.direction != Direction::Input && port.direction != Direction::InOut) continue;
    inputs["properties"][port.name] = {
        {"anyOf", Json::array({{{"$ref", "#/definitions/wire"}}, {{"type", "null"}}})},
        {"description", describePort(port)}};
  }
  for (const ParameterSpec& spec : d.parameters) params["properties"][spec.name] = parameterSchema(spec);
  return {{"description", outputs.empty() ? d.doc : d.doc + "\nOutputs:" + outputs},
          {"properties", {{"inputs", std::move(inputs)}, {"params", std::move(params)}}}};
}

Json viewSchema() {
  Json properties = Json::object();
  for (const ParameterSpec& spec : viewParameters()) properties[spec.name] = parameterSchema(spec);
  return {{"type", Json::array({"object", "null"})},
          {"description", "What belongs to the frame; also set with options, such as --materials"},
          {"additionalProperties", false},
          {"properties", std::move(properties)}};
}

Json inputSchema() {
  Json formats = Json::array();
  for (const gpu::FormatInfo& info : gpu::formats()) formats.push_back(info.name);
  Json size = orParameter({{"type", "integer"}, {"minimum", 1}});
  Json properties{{"doc", {{"type", "string"}}},
                  {"optional", {{"type", "boolean"}, {"description", "of a sub-graph: need not be wired"}}},
                  {"format", {{"enum", std::move(formats)}}},
                  {"light",
                   {{"type", "boolean"},
                    {"description",
                     "of an image: its rgb is light, such as radiance, given as 32-bit floats in the "
                     "units of the scene"}}},
                  {"element", {{"type", "string"}}}};
  for (const char* key : {"width", "height", "depth", "layers", "mips", "stride", "count"})
    properties[key] = size;
  Json input{
      {"type", Json::array({"object", "null"})}, {"additionalProperties", false}, {"properties", properties}};
  Json member = input;
  input["properties"]["bundle"] = {{"type", "string"}};
  input["properties"]["members"] = {{"type", "object"}, {"additionalProperties", std::move(member)}};
  return input;
}

Json passSchema(const Registry& registry, const std::vector<std::string>& types, Json& definitions) {
  Json choices = Json::array(), rules = Json::array();
  for (const std::string& type : types) {
    const PassDeclaration& d = *registry.find(type);
    choices.push_back({{"const", type}, {"description", d.doc}});
    definitions["pass-" + type] = typeSchema(d);
    rules.push_back(
        {{"if", {{"properties", {{"type", {{"const", type}}}}}, {"required", Json::array({"type"})}}},
         {"then", {{"$ref", "#/definitions/pass-" + type}}}});
  }
  Json pass{{"type", Json::array({"object", "null"})}, {"additionalProperties", false}};
  choices.push_back(
      {{"type", "string"}, {"pattern", "\\$"}, {"description", "a type that ends in a graph parameter"}});
  pass["properties"] = {
      {"type", {{"description", "What the pass does"}, {"oneOf", std::move(choices)}}},
      {"graph",
       {{"type", "string"},
        {"description", "A sub-graph's file instead of a type; its passes get this name as prefix"}}},
      {"view", orNull("string")},
      {"inputs",
       {{"type", Json::array({"object", "null"})},
        {"additionalProperties",
         {{"anyOf", Json::array({{{"$ref", "#/definitions/wire"}}, {{"type", "null"}}})}}}}},
      {"params", orNull("object")},
      {"parameters", orNull("object")},
      {"comment", orNull("string")}};
  pass["not"] = {{"type", "object"}, {"required", Json::array({"type", "graph"})}};
  if (!types.empty()) pass["allOf"] = std::move(rules);
  return pass;
}

}  // namespace

std::string generateSchema(const Registry& registry) {
  Json definitions = Json::object();
  definitions["wire"] = {{"type", "string"},
                         {"pattern", "^[A-Za-z0-9_/-]+(\\.[A-Za-z0-9_-]+){0,2}(@previous)?$"},
                         {"description",
                          "pass.port, pass (its only output), pass.port.member or inputs.name; @previous is "
                          "last frame's value"}};
  Json pass = passSchema(registry, registry.types(), definitions);
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "fovea graph"},
              {"type", "object"},
              {"additionalProperties", false}};
  schema["properties"] = {
      {"$schema", {{"type", "string"}}},
      {"version",
       {{"const", kGraphVersion},
        {"description", "Of this format; `fovea migrate` rewrites files of earlier ones"}}},
      {"description", orNull("string")},
      {"extends",
       {{"type", "string"}, {"description", "A graph file that this one changes (RFC 7396); null removes"}}},
      {"parameters",
       {{"type", Json::array({"object", "null"})},
        {"description", "Used as \"$name\", set with --set name=value"},
        {"additionalProperties", {{"type", Json::array({"boolean", "number", "string", "null"})}}}}},
      {"view", viewSchema()},
      {"inputs", {{"type", Json::array({"object", "null"})}, {"additionalProperties", inputSchema()}}},
      {"passes", {{"type", "object"}, {"additionalProperties", std::move(pass)}}},
      {"outputs",
       {{"type", Json::array({"object", "null"})},
        {"additionalProperties",
         {{"anyOf", Json::array({{{"$ref", "#/definitions/wire"}}, {{"type", "null"}}})}}}}}};
  schema["definitions"] = std::move(definitions);
  return schema.dump(2) + "\n";
}

namespace {

Json described(const char* description, Json schema) {
  schema["description"] = description;
  return schema;
}

Json objectOf(Json properties) {
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

Json mapOf(Json values) { return {{"type", "object"}, {"additionalProperties", std::move(values)}}; }

Json anyOf(std::initializer_list<Json> choices) { return {{"anyOf", Json(choices)}}; }

Json resourceProperties() {
  Json formats = Json::array();
  for (const gpu::FormatInfo& info : gpu::formats()) formats.push_back(info.name);
  const Json expression = {{"$ref", "#/definitions/expression"}};
  Json properties{
      {"doc", {{"type", "string"}}},
      {"format", {{"enum", std::move(formats)}}},
      {"light", described("of an output: its rgb is light, such as radiance, relative to frame.preExposure; "
                          "it is read back in the units of the scene",
                          {{"type", "boolean"}})},
      {"element", described("element type of a buffer", {{"type", "string"}})},
      {"stride", described("bytes of an element", {{"type", "integer"}, {"minimum", 1}})},
      {"usage", described("ways to use it, instead of those that follow from the steps",
                          {{"type", "array"}, {"items", {{"type", "string"}}}})}};
  for (const char* key : {"width", "height", "depth", "layers", "mips", "count"})
    properties[key] = expression;
  return properties;
}

// own: properties beside those of the resource.
Json portSchema(const Json& own) {
  Json properties = resourceProperties();
  properties.update(own);
  properties["bundle"] = {{"type", "string"}};
  properties["members"] =
      anyOf({described("names of images of any format", {{"type", "array"}, {"items", {{"type", "string"}}}}),
             mapOf(objectOf(resourceProperties()))});
  return mapOf(anyOf({described("an image; the text is its documentation", {{"type", "string"}}),
                      objectOf(std::move(properties))}));
}

Json stepSchema() {
  const Json text = {{"type", "string"}}, expression = {{"$ref", "#/definitions/expression"}},
             expressions = {{"type", "array"}, {"items", expression}, {"minItems", 1}, {"maxItems", 3}},
             word = {{"type", "integer"}, {"minimum", 0}, {"maximum", 0xffffffffu}};
  return objectOf(
      {{"name", text},
       {"shader", described("a .comp file, or with `colors` a .frag file, beside this file", text)},
       {"colors", described("images that the shader writes: every pixel, or those of `tiles`",
                            {{"type", "array"}, {"items", text}})},
       {"tiles", described("mask of the format r8, with `colors`: only tiles whose texel is not 0 are drawn, "
                           "the rest keeps what an earlier step has written, and otherwise becomes 0",
                           text)},
       {"define", described("preprocessor macros", mapOf(expression))},
       {"constant", described("push constants", mapOf(expression))},
       {"over", described("one thread for each texel or element of this port", text)},
       {"threads", described("threads along x, y and z", expressions)},
       {"groups", described("work groups along x, y and z", expressions)},
       {"indirect", described("buffer that holds the numbers of work groups", text)},
       {"offset", described("of `indirect`, in bytes", {{"type", "integer"}, {"minimum", 0}})},
       {"fill", described("buffer to fill with `word`", text)},
       {"clear", described("image to clear to `word`", text)},
       {"word", word},
       {"copy", described("image to copy to the image `to`", text)},
       {"to", text},
       {"when", described("the step runs if this is not 0", expression)},
       {"together", described("may run at the same time as the step before", {{"type", "boolean"}})}});
}

}  // namespace

std::string passFileSchema() {
  const Json text = {{"type", "string"}};
  const Json input = {
      {"optional", {{"type", "boolean"}}},
      {"when", described("a condition over parameters; the input counts as not wired if this is 0",
                         {{"$ref", "#/definitions/expression"}})}};
  const Json output = {{"keep", {{"enum", {"frame", "view", "scene"}}}}};
  const Json parameter = objectOf({{"doc", text},
                                   {"default", {{"type", Json::array({"boolean", "number", "string"})}}},
                                   {"min", {{"type", "number"}}},
                                   {"max", {{"type", "number"}}},
                                   {"unit", text},
                                   {"choices", {{"type", "array"}, {"items", text}}}});
  Json schema = objectOf(
      {{"$schema", text},
       {"doc", described("what the pass does, in one line", text)},
       {"view", described("whether it renders from a camera", {{"type", "boolean"}})},
       {"rays", described("whether its shaders trace rays, with rays/trace.glsl", {{"type", "boolean"}})},
       {"inputs", portSchema(input)},
       {"updated", portSchema(input)},
       {"outputs", portSchema(output)},
       {"scratch", portSchema(output)},
       {"params", mapOf(parameter)},
       {"counters", mapOf(text)},
       {"steps", {{"type", "array"}, {"minItems", 1}, {"items", stepSchema()}}}});
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "fovea pass";
  schema["required"] = {"doc", "steps"};
  schema["definitions"]["expression"] = {
      {"anyOf", Json::array({{{"type", "integer"}}, {{"type", "boolean"}}, text})},
      {"description",
       "a whole number, or an expression over parameters, view.width, PORT.width, PORT.count, wired(PORT), + "
       "- * / (rounds "
       "up), min, max, ==, !=, !, && and ||"}};
  return schema.dump(2) + "\n";
}

}  // namespace fovea::graph
