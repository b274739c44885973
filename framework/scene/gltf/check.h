// The rules of checkDocument in three parts. Private to framework/scene.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <utility>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {

inline constexpr int64_t kIntMax = 0x7fffffff;  // tinygltf keeps offsets and counts in int

inline std::string at(std::string_view array, size_t i) {
  return std::string(array) + "[" + std::to_string(i) + "]";
}

// The place of an extension of the object at `path`.
inline std::string inside(const std::string& path, std::string_view extension) {
  return json::joinPath(json::joinPath(path, "extensions"), extension);
}

// What the checks find: errors, which spoil the model, and warnings about details that are removed from the document.
struct Findings {
  Diagnostics errors, warnings;
  std::map<const json::Value*, std::set<std::string, std::less<>>> removed;  // members of objects

  // Removes them.
  void apply(json::Value& value) const;
};

// What all parts need: access to lists of objects, indices into other lists, and extensions.
class DocumentReader {
 public:
  using Value = json::Value;
  using ObjectReader = json::ObjectReader;
  DocumentReader(const Value& root, const Source& source, Findings& found)
      : root_(root), source_(source), found_(found), errors_(found.errors) {}

 protected:
  void error(const Value& v, std::string path, std::string message, std::string remedy = {}) {
    errors_.error(v.where.location(), std::move(path), std::move(message), std::move(remedy));
  }

  void warn(const Value& v, std::string path, std::string message, std::string remedy = {}) {
    found_.warnings.warning(v.where.location(), std::move(path), std::move(message), std::move(remedy));
  }

  // Checks a detail without which the model can be shown. If there are mistakes in it, they become warnings that end
  // with `consequence`, and the result is false.
  bool attempt(const std::string& consequence, const std::function<void()>& check) {
    const Diagnostics before = std::exchange(errors_, Diagnostics());
    check();
    const Diagnostics mistakes = std::exchange(errors_, before);
    for (Diagnostic d : mistakes.list()) {
      d.severity = Severity::Warning;
      d.message += ": " + consequence;
      found_.warnings.add(std::move(d));
    }
    return mistakes.list().empty();
  }

  void remove(const Value& object, std::string_view key) { found_.removed[&object].emplace(key); }

  // The same for the member `key` of an object, which is removed if there are mistakes in it.
  bool optional(const Value& object, std::string_view key, const std::string& consequence,
                const std::function<void()>& check) {
    const bool good = attempt(consequence, check);
    if (!good) remove(object, key);
    return good;
  }

  size_t sizeOf(std::string_view array) const {
    const Value* v = root_.find(array);
    return v && v->isArray() ? v->items.size() : 0;
  }

  void each(std::string_view array, const std::function<void(const Value&, const std::string&)>& visit) {
    const Value* v = root_.find(array);
    if (!v) return;
    eachOf(*v, std::string(array), visit);
  }

  // Every item must be an object.
  void eachOf(const Value& v, const std::string& path,
              const std::function<void(const Value&, const std::string&)>& visit) {
    if (!v.isArray()) return error(v, path, "expected an array, found " + v.describe());
    for (size_t i = 0; i < v.items.size(); ++i) {
      if (!v.items[i].isObject())
        error(v.items[i], at(path, i), "expected an object, found " + v.items[i].describe());
      else
        visit(v.items[i], at(path, i));
    }
  }

  bool indexValue(const Value& v, const std::string& path, std::string_view target) {
    const size_t count = sizeOf(target);
    if (!v.isInt()) {
      error(v, path, "expected an index into `" + std::string(target) + "`, found " + v.describe());
      return false;
    }
    if (v.integer < 0 || uint64_t(v.integer) >= count) {
      error(v, path,
            "index " + std::to_string(v.integer) + " into `" + std::string(target) + "`, which has " +
                std::to_string(count) + " entries");
      return false;
    }
    return true;
  }

  // -1 if absent or invalid.
  int64_t index(const Value& object, const std::string& path, std::string_view key, std::string_view target,
                bool required = false) {
    const Value* v = object.find(key);
    if (!v) {
      if (required) error(object, path, "`" + std::string(key) + "` is missing");
      return -1;
    }
    return indexValue(*v, json::joinPath(path, key), target) ? v->integer : -1;
  }

  void indexArray(const Value& object, const std::string& path, std::string_view key,
                  std::string_view target) {
    const Value* v = object.find(key);
    if (!v) return;
    const std::string place = json::joinPath(path, key);
    if (!v->isArray()) return error(*v, place, "expected an array, found " + v->describe());
    for (size_t i = 0; i < v->items.size(); ++i) indexValue(v->items[i], at(place, i), target);
  }

  void numbersIfPresent(const Value& object, const std::string& path, std::string_view key, size_t count) {
    if (object.find(key)) ObjectReader(object, path, errors_).numbers(key, count);
  }

  void nameOfObject(const Value& object, const std::string& path) {
    optional(object, "name", "it has no name", [&] { ObjectReader(object, path, errors_).text("name"); });
  }

  // The extension `name` of an object; null if absent or invalid.
  const Value* extension(const Value& object, const std::string& path, std::string_view name) {
    const Value* all = object.find("extensions");
    if (!all) return nullptr;
    if (!all->isObject()) {
      error(*all, json::joinPath(path, "extensions"), "expected an object, found " + all->describe());
      return nullptr;
    }
    const Value* v = all->find(name);
    if (!v) return nullptr;
    if (!v->isObject()) {
      error(*v, inside(path, name), "expected an object, found " + v->describe());
      return nullptr;
    }
    return v;
  }

  const Value& root_;
  const Source& source_;
  Findings& found_;
  Diagnostics& errors_;  // of found_
};

// Checks version and extensions. If false, nothing else in the file can be trusted to have its usual meaning.
bool checkVersion(const json::Value& root, const Source& source, Findings& found);
// Checks buffers, views, accessors, images and textures: everything that could cause a read past the
// end of something.
void checkData(const json::Value& root, const Source& source, Findings& found);
// Checks materials, meshes, cameras, lights, nodes, skins and animations.
void checkContent(const json::Value& root, const Source& source, Findings& found);
// Reports what is valid and not read.
void checkUnread(const json::Value& root, const Source& source, Findings& found);

}  // namespace fovea::scene::gltf
