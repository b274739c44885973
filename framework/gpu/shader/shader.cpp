#include "framework/gpu/shader/shader.h"

#include <glslang/MachineIndependent/iomapper.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <mutex>
#include <set>

#include "fovea/error.h"
#include "framework/gpu/shader/disk_cache.h"
#include "framework/gpu/shader/shader_source.h"
#include "framework/gpu/shader/spirv_bindings.h"

namespace fovea::gpu {
namespace {

constexpr const char* kCacheVersion = "1";  // to be raised when the options below change
constexpr size_t kMaxIncludeDepth = 64;

constexpr const char* kPreamble =
    "#extension GL_GOOGLE_include_directive : enable\n"
    "#extension GL_EXT_samplerless_texture_functions : enable\n"
    "#extension GL_EXT_ray_query : enable\n";

EShLanguage stageOf(const std::string& name) {
  if (name.ends_with(".comp")) return EShLangCompute;
  if (name.ends_with(".vert")) return EShLangVertex;
  if (name.ends_with(".frag")) return EShLangFragment;
  throw Error(ExitCode::BadInput, "shader `" + name + "`: the stage is not known from the file name",
              "end the name in .comp, .vert or .frag");
}

bool isIdentifier(const std::string& s) {
  return !s.empty() && !std::isdigit(static_cast<unsigned char>(s[0])) &&
         std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

std::string preamble(const std::string& shader, const Defines& defines) {
  std::string text = kPreamble;
  for (const auto& [name, value] : defines) {
    if (!isIdentifier(name) || value.find('\n') != std::string::npos)
      throw Error(ExitCode::Internal,
                  "shader `" + shader + "`: `" + name + "` cannot be defined as `" + value + "`");
    text += "#define " + name + " " + value + "\n";
  }
  return text;
}

// Serves the files that were read and hashed before, so that nothing else can enter the compilation.
class Includer : public glslang::TShader::Includer {
 public:
  explicit Includer(const ShaderSource& source) : source_(source) {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override {
    if (depth > kMaxIncludeDepth)
      return failure("files include each other without end; give them #pragma once");
    const ShaderSource::File* file = source_.find(includer, header);
    if (!file) return failure("file not found; looked beside the including file and in the shader folders");
    const bool repeated = file->once && !seen_.insert(file).second;
    return new IncludeResult(file->name, file->text.data(), repeated ? 0 : file->text.size(), nullptr);
  }
  IncludeResult* includeSystem(const char* header, const char* includer, size_t depth) override {
    return includeLocal(header, includer, depth);
  }
  void releaseInclude(IncludeResult* result) override { delete result; }

 private:
  static IncludeResult* failure(const char* why) {
    return new IncludeResult("", why, std::strlen(why), nullptr);
  }
  const ShaderSource& source_;
  std::set<const ShaderSource::File*> seen_;
};

// Leaves explicit bindings alone and numbers the others from kAutomaticBinding on, so that they can be distinguished.
class AutomaticBindings : public glslang::TIoMapResolver {
 public:
  bool validateBinding(EShLanguage, glslang::TVarEntryInfo&) override { return true; }
  int resolveBinding(EShLanguage, glslang::TVarEntryInfo& ent) override {
    const glslang::TType& type = ent.symbol->getType();
    const glslang::TQualifier& q = type.getQualifier();
    const bool resource =
        type.getBasicType() == glslang::EbtSampler || type.getBasicType() == glslang::EbtBlock;
    if (!resource || !q.isUniformOrBuffer() || q.isPushConstant()) return -1;
    if (q.hasBinding()) {
      if (q.layoutBinding >= kAutomaticBinding)
        problems_.push_back(label(ent) + ": binding number too large");
      return -1;
    }
    if (q.hasSet() && q.layoutSet != 0)
      problems_.push_back(label(ent) + ": a resource outside set 0 needs layout(binding)");
    return ent.newBinding = int(kAutomaticBinding + next_++);
  }
  const std::vector<std::string>& problems() const { return problems_; }

  int resolveSet(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  int resolveUniformLocation(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  bool validateInOut(EShLanguage, glslang::TVarEntryInfo&) override { return true; }
  int resolveInOutLocation(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  int resolveInOutComponent(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  int resolveInOutIndex(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  void notifyBinding(EShLanguage, glslang::TVarEntryInfo&) override {}
  void notifyInOut(EShLanguage, glslang::TVarEntryInfo&) override {}
  void beginNotifications(EShLanguage) override {}
  void endNotifications(EShLanguage) override {}
  void beginResolve(EShLanguage) override {}
  void endResolve(EShLanguage) override {}
  void beginCollect(EShLanguage) override {}
  void endCollect(EShLanguage) override {}
  void reserverStorageSlot(glslang::TVarEntryInfo&, TInfoSink&) override {}
  void reserverResourceSlot(glslang::TVarEntryInfo&, TInfoSink&) override {}
  void addStage(EShLanguage, glslang::TIntermediate&) override {}

 private:
  static std::string label(const glslang::TVarEntryInfo& ent) {
    const glslang::TString& name = ent.symbol->getName();
    const bool anonymous = name.compare(0, 5, "anon@") == 0;
    return "`" + std::string(std::string_view(anonymous ? ent.symbol->getType().getTypeName() : name)) + "`";
  }
  uint32_t next_ = 0;
  std::vector<std::string> problems_;
};

// Parses "ERROR: name:12: message". Names are matched as a whole, since they may contain colons.
Diagnostic parseMessage(std::string_view line, const ShaderSource& source) {
  Diagnostic d;
  if (line.starts_with("ERROR: ")) line.remove_prefix(7);
  if (line.starts_with("WARNING: ")) {
    line.remove_prefix(9);
    d.severity = Severity::Warning;
  }
  for (const ShaderSource::File& file : source.files()) {
    if (file.name.size() <= d.where.file.size() || !line.starts_with(file.name + ":")) continue;
    const std::string_view rest = line.substr(file.name.size() + 1);
    const size_t end = rest.find_first_not_of("0123456789");
    if (end == 0 || end == std::string_view::npos || rest[end] != ':') continue;
    d.where.file = file.name;
    d.where.line = std::stoi(std::string(rest.substr(0, end)));
    d.message = rest.substr(std::min(end + 2, rest.size()));
  }
  if (d.where.file.empty()) {
    d.where.file = source.main().name;
    d.message = line;
  }
  return d;
}

[[noreturn]] void throwCompilerErrors(const char* log, const ShaderSource& source) {
  std::vector<Diagnostic> list;
  const std::string_view text = log;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty() || line.find("compilation errors.  No code generated") != std::string_view::npos ||
        line.find("compilation terminated") != std::string_view::npos)
      continue;
    // "Possible extensions include:" and the names of the extensions are on lines of their own.
    if (!list.empty() && !line.starts_with("ERROR: ") && !line.starts_with("WARNING: "))
      list.back().message += " " + std::string(line);
    else
      list.push_back(parseMessage(line, source));
  }
  if (list.empty())
    list.push_back({Severity::Error, {source.main().name, 0, 0}, {}, "the compiler gave up", {}});
  throw Error(ExitCode::BadInput, std::move(list));
}

// SPIR-V in which automatic bindings have no final numbers, the form that the disk cache keeps.
std::vector<uint32_t> compileGlsl(const ShaderSource& source, EShLanguage stage,
                                  const std::string& preambleText) {
  static const struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
  } process;

  glslang::TShader shader(stage);
  const ShaderSource::File& main = source.main();
  const char* text = main.text.data();
  const int length = int(main.text.size());
  const char* name = main.name.c_str();
  shader.setStringsWithLengthsAndNames(&text, &length, &name, 1);
  shader.setPreamble(preambleText.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  shader.setAutoMapBindings(true);
  // Cascading reports all mistakes at once. Without it the compiler stops at the first one and then reports follow-up
  // errors of that stop.
  const auto messages =
      EShMessages(EShMsgDefault | EShMsgSpvRules | EShMsgVulkanRules | EShMsgCascadingErrors);
  Includer includer(source);
  if (!shader.parse(GetDefaultResources(), 460, ENoProfile, false, false, messages, includer))
    throwCompilerErrors(shader.getInfoLog(), source);

  glslang::TProgram program;
  program.addShader(&shader);
  AutomaticBindings bindings;
  if (!program.link(messages) || !program.mapIO(&bindings)) throwCompilerErrors(program.getInfoLog(), source);
  if (!bindings.problems().empty()) {
    std::vector<Diagnostic> list;
    for (const std::string& problem : bindings.problems())
      list.push_back({Severity::Error, {main.name, 0, 0}, {}, problem, {}});
    throw Error(ExitCode::BadInput, std::move(list));
  }
  std::vector<uint32_t> spirv;
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(stage), spirv, &options);
  return spirv;
}

// Gives automatic bindings the lowest free numbers of set 0; those in use come first.
void numberBindings(std::vector<uint32_t>& spirv, Reflection& reflection) {
  std::vector<BindingDecoration> decorations = bindingDecorations(spirv);
  std::set<uint32_t> taken;
  for (const BindingDecoration& d : decorations) {
    if (d.set == 0 && d.binding < kAutomaticBinding) taken.insert(d.binding);
  }
  const auto used = [&](const BindingDecoration& d) {
    return std::any_of(reflection.bindings.begin(), reflection.bindings.end(),
                       [&](const ReflectedBinding& b) { return b.set == d.set && b.binding == d.binding; });
  };
  std::sort(decorations.begin(), decorations.end(),
            [&](const BindingDecoration& a, const BindingDecoration& b) {
              return std::pair(!used(a), a.binding) < std::pair(!used(b), b.binding);
            });
  std::map<uint32_t, uint32_t> numbers;
  uint32_t next = 0;
  for (const BindingDecoration& d : decorations) {
    if (d.binding < kAutomaticBinding) continue;
    while (taken.contains(next)) ++next;
    numbers[d.binding] = spirv[d.word] = next++;
  }
  for (ReflectedBinding& b : reflection.bindings) {
    if (b.automatic) b.binding = numbers.at(b.binding);
  }
  std::sort(reflection.bindings.begin(), reflection.bindings.end(),
            [](const ReflectedBinding& a, const ReflectedBinding& b) {
              return std::tie(a.set, a.binding, a.name) < std::tie(b.set, b.binding, b.name);
            });
}

}  // namespace

struct ShaderCompiler::Impl {
  std::filesystem::path cacheDirectory;
  std::vector<std::filesystem::path> searchPaths;
  std::map<std::string, std::shared_ptr<const CompiledShader>> kept;
  Statistics statistics;
  Defines always;
  mutable std::mutex mutex;

  std::shared_ptr<const CompiledShader> make(const std::string& name, const ShaderSource& source,
                                             const Defines& defines);
  std::vector<uint32_t> fetchOrCompile(const ShaderSource& source, EShLanguage stage,
                                       const std::string& preambleText, const ContentKey& key);
};

std::vector<uint32_t> ShaderCompiler::Impl::fetchOrCompile(const ShaderSource& source, EShLanguage stage,
                                                           const std::string& preambleText,
                                                           const ContentKey& key) {
  constexpr uint32_t kSpirvMagic = 0x07230203;
  const std::filesystem::path file = cacheDirectory / ("shader-" + key.hex() + ".spv");
  if (!cacheDirectory.empty()) {
    if (const auto payload = readCacheFile(file);
        payload && payload->size() >= 20 && payload->size() % 4 == 0) {
      std::vector<uint32_t> spirv(payload->size() / 4);
      std::memcpy(spirv.data(), payload->data(), payload->size());
      if (spirv[0] == kSpirvMagic) {
        ++statistics.fromDisk;
        return spirv;
      }
    }
  }
  std::vector<uint32_t> spirv = compileGlsl(source, stage, preambleText);
  ++statistics.compiled;
  if (!cacheDirectory.empty()) writeCacheFile(file, std::as_bytes(std::span(spirv)));
  return spirv;
}

std::shared_ptr<const CompiledShader> ShaderCompiler::Impl::make(const std::string& name,
                                                                 const ShaderSource& source,
                                                                 const Defines& defines) {
  const EShLanguage stage = stageOf(name);
  Defines all = always;
  all.insert(defines.begin(), defines.end());
  const std::string preambleText = preamble(name, all);
  const glslang::Version version = glslang::GetVersion();
  std::string content = std::string(kCacheVersion) + "/" + std::to_string(version.major) + "." +
                        std::to_string(version.minor) + "." + std::to_string(version.patch) + version.flavor +
                        "/" + std::to_string(glslang::GetSpirvGeneratorVersion()) + "/" +
                        std::to_string(int(stage)) + "/" + std::to_string(preambleText.size()) + ":" +
                        preambleText + source.serialize();
  const ContentKey key = contentKey(content);
  auto shader = std::make_shared<CompiledShader>();
  shader->file = source.main().name;
  shader->hash = key.low;
  shader->spirv = fetchOrCompile(source, stage, preambleText, key);
  shader->reflection = reflect(shader->spirv);
  numberBindings(shader->spirv, shader->reflection);
  return shader;
}

ShaderCompiler::ShaderCompiler(std::filesystem::path cacheDirectory, Defines always)
    : impl_(std::make_unique<Impl>()) {
  impl_->cacheDirectory = std::move(cacheDirectory);
  impl_->always = std::move(always);
}

ShaderCompiler::~ShaderCompiler() = default;

void ShaderCompiler::addSearchPath(std::filesystem::path path) {
  const std::lock_guard lock(impl_->mutex);
  if (std::find(impl_->searchPaths.begin(), impl_->searchPaths.end(), path) == impl_->searchPaths.end())
    impl_->searchPaths.push_back(std::move(path));
}

std::shared_ptr<const CompiledShader> ShaderCompiler::compile(const std::string& name,
                                                              const Defines& defines) {
  const std::lock_guard lock(impl_->mutex);
  std::string id = "file\n" + name;
  for (const auto& [key, value] : defines) id += "\n" + key + " " + value;
  if (const auto it = impl_->kept.find(id); it != impl_->kept.end()) {
    ++impl_->statistics.fromMemory;
    return it->second;
  }
  return impl_->kept[id] = impl_->make(name, ShaderSource::fromFile(name, impl_->searchPaths), defines);
}

std::shared_ptr<const CompiledShader> ShaderCompiler::compileSource(const std::string& name,
                                                                    const std::string& source,
                                                                    const Defines& defines) {
  const std::lock_guard lock(impl_->mutex);
  return impl_->make(name, ShaderSource::fromText(name, source, impl_->searchPaths), defines);
}

void ShaderCompiler::forget() {
  const std::lock_guard lock(impl_->mutex);
  impl_->kept.clear();
}

ShaderCompiler::Statistics ShaderCompiler::statistics() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->statistics;
}

}  // namespace fovea::gpu
