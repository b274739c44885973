#include "framework/graph/report/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/gpu/format.h"
#include "framework/graph/compile/fitting.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/pass/validate.h"
#include "framework/graph/report/settings.h"

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
  if (spec.type == ParameterSpec::Type::Int && !spec.choices.empty()) {
    for (const std::string& allowed : spec.choices) value["enum"].push_back(std::stoll(allowed));
  } else {
    bound("minimum", spec.min);
    bound("maximum", spec.max);
  }
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

// ---- Files that extend a known graph -----------------------------------------------------------------

// Refuses references to graph parameters other than these.
Json referencesTo(const std::vector<std::string>& names) {
  const Json value{
      {"anyOf", Json::array({{{"not", {{"type", "string"}}}},
                             {{"pattern", fmt::format("^([^$]|$|\\$\\$|\\$(scene|device)\\.|\\$({})$)",
                                                      fmt::join(names, "|"))}}})}};
  const Json values{{"additionalProperties", value}};
  return {{"properties",
           {{"view", values},
            {"passes",
             {{"additionalProperties", {{"properties", {{"params", values}, {"parameters", values}}}}}}}}}};
}

// A pass that has no type of its own has that of the extended graph, which is one of these.
Json changeOf(const std::vector<std::string>& types) {
  Json choices = Json::array();
  for (const std::string& type : types) choices.push_back({{"$ref", "#/definitions/pass-" + type}});
  return {{"if", {{"$ref", "#/definitions/new"}}},
          {"else", types.size() == 1 ? choices[0] : Json{{"anyOf", choices}}}};
}

// What a parameter reaches says what it may be.
Json settingSchema(const Setting& setting, const Description& description) {
  Json all = Json::array();
  for (const PassDescription& pass : description.passes)
    for (uint32_t i = 0; pass.type && i < pass.parameterCount; ++i) {
      const ParameterDescription& given = description.parameters[pass.firstParameter + i];
      if (given.from != setting.parameter) continue;
      Json reference{{"$ref", fmt::format("#/definitions/pass-{}/properties/params/properties/{}",
                                          pass.type->string, given.given->key)}};
      if (std::find(all.begin(), all.end(), reference) == all.end()) all.push_back(std::move(reference));
    }
  if (all.empty() && setting.spec.type == ParameterSpec::Type::Choice)
    return orParameter({{"enum", setting.spec.choices}});
  return all.empty() ? Json::object() : all.size() == 1 ? all[0] : Json{{"allOf", std::move(all)}};
}

// Adds to `definitions` those of changes of passes.
Json extensionSchema(const KnownGraph& graph, const Registry& registry, Json& definitions) {
  const Description& description = graph.description;
  Json passes = Json::object(), parameters = Json::object();
  std::vector<std::string> names;
  for (const Setting& setting : declaredSettings(description, registry)) {
    if (!description.graphParameters[setting.parameter].target.empty()) continue;
    names.push_back(setting.name);
    parameters[setting.name] = settingSchema(setting, description);
  }
  for (const PassDescription& pass : description.passes) {
    if (pass.name.find('/') != std::string::npos || !pass.type) continue;
    std::vector<std::string> types;
    if (pass.typeFrom)
      for (const std::string& ending : typeEndings(description, registry, *pass.typeFrom))
        types.push_back(startOfType(pass) + ending);
    else
      types.push_back(pass.type->string);
    std::erase_if(types, [&](const std::string& type) { return !registry.find(type); });
    if (types.empty()) continue;
    const std::string name = "change-" + fmt::format("{}", fmt::join(types, "-or-"));
    if (!definitions.contains(name)) definitions[name] = changeOf(types);
    passes[pass.name] = {{"$ref", "#/definitions/" + name}};
  }
  for (const std::string& instance : description.instances) passes[instance] = Json::object();
  return {
      {"properties",
       {{"parameters", {{"properties", std::move(parameters)}}},
        {"passes",
         {{"properties", std::move(passes)}, {"additionalProperties", {{"$ref", "#/definitions/new"}}}}}}},
      // A file that adds no parameter can refer only to those that there are.
      {"if", {{"properties", {{"parameters", {{"propertyNames", {{"enum", names}}}}}}}}},
      {"then", referencesTo(names)}};
}

// The names by which other files extend a graph: from its folder and from the one above, with and without its ending.
std::vector<std::string> namesOf(const KnownGraph& graph) {
  const std::string bare = graph.name.substr(graph.name.rfind('/') + 1);
  std::vector<std::string> names = {graph.name, graph.name + ".json"};
  if (bare != graph.name) names.insert(names.end(), {bare, bare + ".json"});
  return names;
}

void addExtensions(Json& schema, const Registry& registry, const std::vector<KnownGraph>& graphs) {
  Json& definitions = schema["definitions"];
  const auto has = [](const char* key) { return Json{{"required", Json::array({key})}}; };
  definitions["new"] = {{"description", "a pass that is new, or replaced or removed as a whole"},
                        {"anyOf", Json::array({Json{{"type", "null"}}, has("type"), has("graph")})}};
  Json rules = Json::array();
  rules.push_back({{"if", {{"not", {{"anyOf", Json::array({has("extends"), has("parameters")})}}}}},
                   {"then", referencesTo({})}});
  // Graphs with the same passes and parameters share a definition.
  std::vector<std::pair<Json, std::vector<std::string>>> extensions;
  for (const KnownGraph& graph : graphs) {
    Json extension = extensionSchema(graph, registry, definitions);
    auto at = std::find_if(extensions.begin(), extensions.end(),
                           [&](const auto& e) { return e.first == extension; });
    if (at == extensions.end())
      at = extensions.insert(at, {std::move(extension), std::vector<std::string>()});
    for (std::string& name : namesOf(graph)) at->second.push_back(std::move(name));
  }
  for (auto& [extension, names] : extensions) {
    Json condition{{"properties", {{"extends", {{"enum", names}}}}}, {"required", Json::array({"extends"})}};
    rules.push_back({{"if", std::move(condition)}, {"then", std::move(extension)}});
  }
  schema["allOf"] = std::move(rules);
}

}  // namespace

std::string generateSchema(const Registry& registry, const std::vector<KnownGraph>& graphs) {
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
  addExtensions(schema, registry, graphs);
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
       {"requires", described("what has to hold of parameters, wires and the sizes of inputs",
                              {{"type", "array"},
                               {"items", objectOf({{"condition", {{"$ref", "#/definitions/expression"}}},
                                                   {"otherwise", described("what is wrong if it is 0", text)},
                                                   {"remedy", text}})}})},
       {"steps", {{"type", "array"}, {"minItems", 1}, {"items", stepSchema()}}}});
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "fovea pass";
  schema["required"] = {"doc", "steps"};
  schema["definitions"]["expression"] = {
      {"anyOf", Json::array({{{"type", "integer"}}, {{"type", "boolean"}}, text})},
      {"description",
       "a whole number, or an expression over parameters, view.width, PORT.width, PORT.count, wired(PORT), + "
       "- * / (rounds "
       "up), min, max, same, ==, !=, <=, !, && and ||"}};
  return schema.dump(2) + "\n";
}

}  // namespace fovea::graph
