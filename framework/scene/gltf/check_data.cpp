// Checks sizes and offsets in a glTF document: buffers, views, accessors, images.
#include <algorithm>
#include <array>
#include <set>

#include "framework/scene/gltf/check.h"

namespace fovea::scene::gltf {
namespace {

int componentBytes(int64_t type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

int componentCount(const std::string& type) {
  static const std::array<std::pair<const char*, int>, 7> kTypes = {
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
  for (const auto& [name, count] : kTypes)
    if (type == name) return count;
  return 0;
}

// Columns of matrices start at multiples of four bytes (glTF 2.0, 3.6.2.4).
int64_t elementBytes(const std::string& type, int64_t componentType) {
  const int bytes = componentBytes(componentType);
  if (type == "MAT2" && bytes == 1) return 8;
  if (type == "MAT3" && bytes == 1) return 12;
  if (type == "MAT3" && bytes == 2) return 24;
  return int64_t(componentCount(type)) * bytes;
}

class DataChecker : DocumentReader {
 public:
  using DocumentReader::DocumentReader;
  void run() {
    checkBuffers();
    checkBufferViews();
    findCompressedAccessors();
    findShapes();
    each("accessors", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      if (shapes_.contains(&v)) return checkAccessor(v, path);
      if (!attempt("what it is for is left out", [&] { checkAccessor(v, path); })) remove(v, "count");
    });
    checkImagesAndTextures();
  }

 private:
  void checkUri(const Value& object, const std::string& path, bool mustExist) {
    const Value* uri = object.find("uri");
    if (!uri) return;
    const std::string place = path + ".uri";
    if (!uri->isString()) return error(*uri, place, "expected a text, found " + uri->describe());
    if (isDataUri(uri->string)) {
      if (!dataOf(uri->string))
        error(*uri, place, "the data uri has no data that can be read",
              "write data:application/octet-stream;base64, and the data");
      return;
    }
    const ResolvedUri r = resolveUri(source_, uri->string);
    if (!r.problem.empty())
      return error(*uri, place, "uri \"" + uri->string.substr(0, 200) + "\": " + r.problem, r.remedy);
    std::error_code ec;
    if (mustExist && !std::filesystem::is_regular_file(r.file, ec))
      error(*uri, place, whyMissing(r.file), "copy it beside the model");
  }

  void checkBuffers() {
    uint64_t total = 0;
    size_t i = 0;
    each("buffers", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      if (!r.require("byteLength")) return;
      const int64_t size = r.integer("byteLength", 0, 1, int64_t(kMaxFileBytes));
      if (const Value* e = extension(v, path, kMeshopt))
        ObjectReader(*e, inside(path, kMeshopt), errors_).boolean("fallback", false);
      if (isPlaceholder(v)) return void(++i);
      total += uint64_t(std::max<int64_t>(size, 0));
      checkUri(v, path, true);
      if (!v.find("uri")) {
        if (!source_.binary || i > 0)
          error(v, path, "the buffer has no uri",
                "only the first buffer of a GLB file may live in the file itself");
        else if (uint64_t(size) > source_.chunk.size())
          error(v, path,
                "byteLength " + std::to_string(size) + " exceeds the GLB's BIN chunk of " +
                    std::to_string(source_.chunk.size()) + " bytes");
      }
      ++i;
    });
    if (total > kMaxBufferBytes)
      error(*root_.find("buffers"), "buffers",
            "the buffers have " + std::to_string(total) + " bytes in all; at most " +
                std::to_string(kMaxBufferBytes) + " can be read");
    bufferBytes_ = total;
  }

  void checkBufferViews() {
    uint64_t compressed = 0;
    each("bufferViews", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      ObjectReader r(v, path, errors_);
      const int64_t buffer = index(v, path, "buffer", "buffers", true);
      const int64_t offset = r.integer("byteOffset", 0, 0, kIntMax);
      const int64_t length = r.require("byteLength") ? r.integer("byteLength", 0, 1, kIntMax) : 0;
      r.integer("byteStride", 4, 1, 252);
      r.integer("target", 34962, 0, kIntMax);
      if (buffer < 0) return;
      checkRange(v, path, buffer, offset, length);
      if (const Value* e = extension(v, path, kMeshopt)) {
        compressed += checkCompressed(*e, inside(path, kMeshopt), v);
        if (compressed > bufferBytes_)
          error(*e, inside(path, kMeshopt), "the compressed data of different buffer views overlap");
      } else if (isPlaceholder(root_.find("buffers")->items[size_t(buffer)])) {
        error(v, path,
              "buffers[" + std::to_string(buffer) +
                  "] has no data of its own: only compressed buffer views " + "can lie in it");
      }
    });
  }

  void checkRange(const Value& v, const std::string& path, int64_t buffer, int64_t offset, int64_t length) {
    const int64_t size = integerAt("buffers", buffer, "byteLength", 0);
    if (offset + length > size)
      error(v, path,
            "bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) + " of buffers[" +
                std::to_string(buffer) + "], which has " + std::to_string(size) + " bytes");
  }

  // Returns the number of compressed bytes.
  uint64_t checkCompressed(const Value& e, const std::string& path, const Value& view) {
    ObjectReader r(e, path, errors_);
    const int64_t buffer = index(e, path, "buffer", "buffers", true);
    const int64_t offset = r.integer("byteOffset", 0, 0, kIntMax);
    const int64_t length = r.require("byteLength") ? r.integer("byteLength", 0, 1, kIntMax) : 0;
    const int64_t stride = r.require("byteStride") ? r.integer("byteStride", 0, 1, 256) : 0;
    const int64_t count = r.require("count") ? r.integer("count", 0, 1, kIntMax) : 0;
    const std::string mode =
        r.require("mode") ? r.choice("mode", "", {"ATTRIBUTES", "TRIANGLES", "INDICES"}) : "";
    const std::string filter =
        r.choice("filter", "NONE", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
    if (buffer < 0 || length == 0 || stride == 0 || count == 0 || mode.empty()) return 0;
    checkRange(e, path, buffer, offset, length);
    if (isPlaceholder(root_.find("buffers")->items[size_t(buffer)]))
      error(e, path, "buffers[" + std::to_string(buffer) + "] has no data of its own");
    checkLayout(e, path, stride, count, mode, filter);
    const Value* written = view.find("byteLength");
    if (written && written->integer != count * stride)
      error(e, path,
            std::to_string(count) + " elements of " + std::to_string(stride) +
                " bytes do not fill the byteLength " + std::to_string(written->integer) +
                " of the buffer view");
    if (const Value* s = view.find("byteStride"); s && s->integer != stride)
      error(e, path,
            "byteStride " + std::to_string(stride) + " is not that of the buffer view, " +
                std::to_string(s->integer));
    // The densest block has 4 bytes for 256 elements of each byte of the stride.
    constexpr int64_t kDensest = 64;
    if (count * stride > kDensest * length)
      error(e, path,
            std::to_string(length) + " bytes cannot hold " + std::to_string(count) + " elements of " +
                std::to_string(stride) + " bytes: the data is cut short, or `count` is wrong");
    return uint64_t(length);
  }

  // The strides that each mode and each filter have.
  void checkLayout(const Value& e, const std::string& path, int64_t stride, int64_t count,
                   const std::string& mode, const std::string& filter) {
    const bool attributes = mode == "ATTRIBUTES";
    if (attributes ? stride % 4 != 0 : stride != 2 && stride != 4)
      error(e, path, "byteStride " + std::to_string(stride) + " is impossible in mode " + mode,
            attributes ? "a multiple of 4 up to 256 is possible" : "2 and 4 are possible");
    if (mode == "TRIANGLES" && count % 3 != 0)
      error(e, path, "count " + std::to_string(count) + " is no multiple of 3, as in mode TRIANGLES");
    if (!attributes && filter != "NONE")
      error(e, path, "filter " + filter + " is for mode ATTRIBUTES, this is " + mode);
    if ((filter == "OCTAHEDRAL" && stride != 4 && stride != 8) || (filter == "QUATERNION" && stride != 8))
      error(e, path, "byteStride " + std::to_string(stride) + " is impossible with filter " + filter,
            filter == "QUATERNION" ? "8 is possible" : "4 and 8 are possible");
  }

  // A number of another object, of any type; the check of that object reports an invalid one.
  int64_t integerAt(std::string_view array, int64_t i, std::string_view key, int64_t fallback) const {
    const Value* v = root_.find(array);
    const Value* member = v->items[size_t(i)].find(key);
    return member && member->isInt() && member->integer >= 0 && member->integer <= kIntMax ? member->integer
                                                                                           : fallback;
  }

  void checkSpan(const Value& v, const std::string& path, int64_t view, int64_t offset, int64_t count,
                 int64_t bytes, bool strided) {
    if (view < 0 || count <= 0 || bytes <= 0) return;
    const int64_t stride = strided ? integerAt("bufferViews", view, "byteStride", bytes) : bytes;
    const int64_t length = integerAt("bufferViews", view, "byteLength", 0);
    if (length == 0) return;  // reported with the view
    if (stride < bytes)
      return error(v, path,
                   "elements of " + std::to_string(bytes) + " bytes overlap: bufferViews[" +
                       std::to_string(view) + "].byteStride is " + std::to_string(stride));
    // All factors are below 2^31, so 64 bits do not overflow.
    const int64_t end = offset + (count - 1) * stride + bytes;
    if (end > length)
      error(v, path,
            std::to_string(count) + " elements end at byte " + std::to_string(end) + " of bufferViews[" +
                std::to_string(view) + "], which has " + std::to_string(length) + " bytes");
  }

  void checkAccessor(const Value& v, const std::string& path) {
    ObjectReader r(v, path, errors_);
    const int64_t view = index(v, path, "bufferView", "bufferViews");
    const int64_t offset = r.integer("byteOffset", 0, 0, kIntMax);
    const int64_t count = r.require("count") ? r.integer("count", 0, 1, kIntMax) : 0;
    const int64_t component = r.require("componentType") ? r.integer("componentType", 0, 0, kIntMax) : 0;
    const std::string type = r.require("type") ? r.text("type") : "";
    r.boolean("normalized", false);
    if (v.find("componentType") && componentBytes(component) == 0)
      return error(
          v, path,
          "componentType " + std::to_string(component) + " is none of 5120, 5121, 5122, 5123, 5125, 5126");
    if (componentCount(type) == 0) {
      if (v.find("type") && v.find("type")->isString())
        error(v, path,
              "type \"" + type.substr(0, 32) + "\" is none of SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
      return;
    }
    for (const char* key : {"min", "max"})
      optional(v, key, "it is not needed",
               [&] { numbersIfPresent(v, path, key, size_t(componentCount(type))); });
    checkSpan(v, path, view, offset, count, elementBytes(type, component), true);
    if (!v.find("bufferView") && uint64_t(count) > kMaxZeroElements && !compressed_.contains(&v))
      error(v, path,
            "an accessor without a bufferView claims " + std::to_string(count) + " elements; at most " +
                std::to_string(kMaxZeroElements) + " are accepted");
    if (v.find("sparse"))
      checkSparse(*v.find("sparse"), path + ".sparse", count, elementBytes(type, component));
  }

  // Accessors that get their elements from a compressed primitive, where their number is checked.
  void findCompressedAccessors() {
    if (!isSupported(kDraco)) return;
    const Value* accessors = root_.find("accessors");
    const auto add = [&](const Value* i) {
      if (i && i->isInt() && i->integer >= 0 && uint64_t(i->integer) < sizeOf("accessors"))
        compressed_.insert(&accessors->items[size_t(i->integer)]);
    };
    const Value* meshes = root_.find("meshes");
    for (size_t m = 0; m < sizeOf("meshes"); ++m) {
      const Value* primitives = meshes->items[m].find("primitives");
      for (size_t i = 0; primitives && i < primitives->items.size(); ++i) {
        const Value* p = &primitives->items[i];
        const Value* e = extensionOf(p, kDraco);
        if (!e) continue;
        add(p->find("indices"));
        if (const Value* decoded = e->find("attributes"))
          for (const json::Member& a : decoded->members) add(memberOf(p->find("attributes"), a.key));
      }
    }
  }

  // Accessors without which there is no geometry: positions and indices.
  void findShapes() {
    const auto add = [&](const Value* object, std::string_view key) {
      const int i = indexIn(object, key);
      if (i >= 0 && size_t(i) < sizeOf("accessors"))
        shapes_.insert(&root_.find("accessors")->items[size_t(i)]);
    };
    for (const Value& mesh : itemsOf(&root_, "meshes"))
      for (const Value& p : itemsOf(&mesh, "primitives")) {
        add(&p, "indices");
        add(p.find("attributes"), "POSITION");
      }
  }

  void checkSparse(const Value& v, const std::string& path, int64_t elements, int64_t bytes) {
    if (!v.isObject()) return error(v, path, "expected an object, found " + v.describe());
    ObjectReader r(v, path, errors_);
    const int64_t count = r.require("count") ? r.integer("count", 0, 1, std::max<int64_t>(elements, 1)) : 0;
    for (const char* key : {"indices", "values"}) {
      const Value* part = r.require(key) ? r.object(key) : nullptr;
      if (!part) continue;
      const std::string place = json::joinPath(path, key);
      ObjectReader p(*part, place, errors_);
      const int64_t view = index(*part, place, "bufferView", "bufferViews", true);
      const int64_t offset = p.integer("byteOffset", 0, 0, kIntMax);
      int64_t size = bytes;
      if (std::string_view(key) == "indices") {
        const int64_t component = p.require("componentType") ? p.integer("componentType", 0, 0, kIntMax) : 0;
        if (component != 5121 && component != 5123 && component != 5125) {
          error(*part, place, "componentType " + std::to_string(component) + " is none of 5121, 5123, 5125");
          continue;
        }
        size = componentBytes(component);
      }
      checkSpan(*part, place, view, offset, count, size, false);
    }
  }

  void checkImagesAndTextures() {
    each("images", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      const bool good = attempt("the image is left out", [&] { checkImage(v, path); });
      if (!good)
        for (const char* key : {"uri", "bufferView"}) remove(v, key);
    });
    each("samplers", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      checkWord(v, path, "wrapS", {33071, 33648, 10497}, "the texture repeats");
      checkWord(v, path, "wrapT", {33071, 33648, 10497}, "the texture repeats");
      checkWord(v, path, "magFilter", {9728, 9729}, "the filter is ignored");
      checkWord(v, path, "minFilter", {9728, 9729, 9984, 9985, 9986, 9987}, "the filter is ignored");
    });
    each("textures", [&](const Value& v, const std::string& path) {
      nameOfObject(v, path);
      optional(v, "source", "the texture is left out", [&] { index(v, path, "source", "images"); });
      optional(v, "sampler", "the texture repeats and is interpolated",
               [&] { index(v, path, "sampler", "samplers"); });
    });
  }

  void checkImage(const Value& v, const std::string& path) {
    const int64_t view = index(v, path, "bufferView", "bufferViews");
    if (view >= 0 && extensionOf(&root_.find("bufferViews")->items[size_t(view)], kMeshopt))
      error(v, path, "the image lies in bufferViews[" + std::to_string(view) + "], which is compressed");
    if (v.find("uri") && v.find("bufferView"))
      error(v, path, "an image has either a uri or a bufferView, this one both");
    if (!v.find("uri") && !v.find("bufferView")) error(v, path, "the image has neither uri nor bufferView");
    checkUri(v, path, false);
  }

  // A number that stands for a word.
  void checkWord(const Value& v, const std::string& path, std::string_view key,
                 std::initializer_list<int64_t> known, const char* consequence) {
    const Value* word = v.find(key);
    if (!word) return;
    optional(v, key, consequence, [&] {
      if (!word->isInt() || std::find(known.begin(), known.end(), word->integer) == known.end())
        error(*word, json::joinPath(path, key), "none of the values that glTF defines: " + word->describe());
    });
  }

  uint64_t bufferBytes_ = 0;  // of buffers that are read
  std::set<const Value*> compressed_, shapes_;
};

}  // namespace

void checkData(const json::Value& root, const Source& source, Findings& found) {
  DataChecker(root, source, found).run();
}

}  // namespace fovea::scene::gltf
