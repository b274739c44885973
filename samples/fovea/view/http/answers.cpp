#include "samples/fovea/view/http/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "fovea/error.h"
#include "samples/fovea/view/graph/describe.h"
#include "samples/fovea/view/http/page.h"
#include "samples/fovea/view/picture/compare.h"
#include "samples/fovea/view/picture/display.h"
#include "samples/fovea/view/picture/export.h"
#include "samples/fovea/view/picture/texels.h"

namespace fovea::view {
namespace {

constexpr int kWaiters = 16;  // requests that may wait for pictures at once

std::string_view mediaType(std::string_view file) {
  if (file.ends_with(".html")) return "text/html; charset=utf-8";
  if (file.ends_with(".css")) return "text/css; charset=utf-8";
  if (file.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (file.ends_with(".svg")) return "image/svg+xml";
  return "text/plain; charset=utf-8";
}

nlohmann::json messagesJson(const Error& error) {
  nlohmann::json list = nlohmann::json::array();
  for (const Diagnostic& d : error.diagnostics())
    list.push_back({{"message", d.message}, {"path", d.path}, {"remedy", d.remedy}});
  return {{"messages", list}};
}

}  // namespace

Answer busy() { return {503, "text/plain; charset=utf-8", "too many requests at once"}; }

Answer Answers::answer(const Request& request, const ReadBody& body) {
  const Verdict verdict = check(request, access_);
  if (verdict.status != 200) return {verdict.status, "text/plain; charset=utf-8", verdict.reason + "\n"};
  try {
    return served(request, verdict.name, body);
  } catch (const Error& e) {
    return {404, "text/plain; charset=utf-8", e.what()};
  } catch (const std::exception& e) {
    return {503, "text/plain; charset=utf-8", e.what()};
  }
}

Answer Answers::served(const Request& request, const std::string& name, const ReadBody& body) {
  const std::string_view query = request.query;
  if (request.method == "POST")
    return name == "control" ? command(request, body) : Answer{404, "text/plain", "not found\n"};
  if (name == "picture") return picture(query);
  if (name == "picture.png" || name == "picture.exr") return file(name, query);
  if (name == "pixels") return pixels(query);
  if (name == "statistics") return numbersOf(query);
  if (name == "measures") return measures(query);
  if (name == "state") return {200, "application/json", exchange_.state()};
  if (name == "gaze.csv")
    return {200, "text/csv", exchange_.gazeTable(),
            "Content-Disposition: attachment; filename=\"gaze.csv\"\r\n"};
  if (name == "camera.json")
    return {200, "application/json", exchange_.cameraKeys(),
            "Content-Disposition: attachment; filename=\"camera.json\"\r\n"};
  for (const PageFile& file : pageFiles())
    if (file.name == (name.empty() ? "index.html" : name))
      return {200, std::string(mediaType(file.name)), std::string(file.text)};
  return {404, "text/plain", "not found\n"};
}

// nullptr if there is no picture, with the answer that says so.
ShotPointer Answers::shotOf(const std::string& source, uint64_t after, Answer& refusal) {
  if (source.empty() || source.size() > 256) {
    refusal = {400, "text/plain; charset=utf-8", "name a source"};
    return nullptr;
  }
  const Place place(waiters_, kWaiters);
  if (!place) {
    refusal = busy();
    return nullptr;
  }
  ShotPointer shot = exchange_.shot(source, after, wait_);
  if (!shot || shot->absent) {
    refusal = {204, "text/plain", {}};  // ask again
    return nullptr;
  }
  if (!shot->refusal.empty()) {
    refusal = {404, "text/plain; charset=utf-8", shot->refusal};
    return nullptr;
  }
  return shot;
}

ShotPointer Answers::shotFor(std::string_view query, Answer& refusal) {
  return shotOf(queryValue(query, "source").value_or(""), uint64_t(queryNumber(query, "after", 0, 9e15, 0)),
                refusal);
}

std::pair<ShotPointer, ShotPointer> Answers::pairFor(std::string_view query, const char* name,
                                                     Answer& refusal) {
  constexpr int kTries = 4;
  const std::string source = queryValue(query, "source").value_or(""),
                    other = queryValue(query, name).value_or("");
  auto after = uint64_t(queryNumber(query, "after", 0, 9e15, 0));
  uint64_t otherAfter = 0;
  for (int i = 0; i < kTries; ++i) {
    ShotPointer a = shotOf(source, after, refusal);
    ShotPointer b = a ? shotOf(other, otherAfter, refusal) : nullptr;
    if (!b) return {};
    if (a->frame == b->frame) return {std::move(a), std::move(b)};
    // Whichever is behind is taken anew.
    if (a->frame < b->frame) after = a->number;
    if (b->frame < a->frame) otherAfter = b->number;
  }
  refusal = {204, "text/plain", {}};
  return {};
}

namespace {

std::string shotHeaders(const Shot& shot) {
  const Layout layout = layoutOf(shot.data.desc);
  constexpr const char* kTypes[] = {"float32", "uint32", "int32"};
  return fmt::format(
      "X-Fovea-Number: {}\r\nX-Fovea-Frame: {}\r\nX-Fovea-Size: {}x{}\r\nX-Fovea-Channels: {}\r\n"
      "X-Fovea-Type: {}\r\nX-Fovea-Encoded: {}\r\nX-Fovea-Frames: {}\r\n",
      shot.number, shot.frame, layout.width, layout.height, layout.channels, kTypes[int(layout.type)],
      layout.encoded ? 1 : 0, shot.frames);
}

// What a browser decodes, or the three bytes of each pixel.
Answer pictureOf(const graph::OutputData& data, const Display& display, const Shot& shot) {
  constexpr std::array kMaps{"automatic", "plain", "helix", "signed"};
  const Pixels pixels = draw(data, display);
  const std::string headers =
      shotHeaders(shot) + fmt::format("X-Fovea-Drawn: {}x{}\r\nX-Fovea-Map: {}\r\nX-Fovea-Range: {} {}\r\n",
                                      pixels.width, pixels.height, kMaps[size_t(pixels.map)], pixels.low,
                                      pixels.high);
  if (display.exact)
    return {200, "application/octet-stream", std::string(pixels.rgb.begin(), pixels.rgb.end()), headers};
  return {200, "image/jpeg", jpeg(pixels, display.quality), headers};
}

}  // namespace

Answer Answers::picture(std::string_view query) {
  Answer refusal;
  const Display display = parseDisplay(query);
  if (queryValue(query, "minus")) {
    const auto [a, b] = pairFor(query, "minus", refusal);
    if (!a || !b) return refusal;
    return pictureOf(difference(a->data, b->data), display, *a);
  }
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  if (shot->data.desc.kind == graph::ResourceKind::Buffer)
    return {200, "application/octet-stream", {}, shotHeaders(*shot)};
  return pictureOf(shot->data, display, *shot);
}

Answer Answers::file(const std::string& name, std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  std::string source = queryValue(query, "source").value_or("");
  std::replace_if(
      source.begin(), source.end(),
      [](char c) { return !std::isalnum(static_cast<unsigned char>(c)) && c != '.'; }, '_');
  const bool exr = name.ends_with(".exr");
  return {200, exr ? "image/x-exr" : "image/png",
          exr ? exrFile(*shot, source) : pngFile(*shot, parseDisplay(query)),
          fmt::format("Content-Disposition: attachment; filename=\"{}_{:04}.{}\"\r\n", source, shot->frame,
                      exr ? "exr" : "png")};
}

namespace {

// The region that a query names; what it leaves out is that of `otherwise`. nullopt if it begins outside.
std::optional<Region> regionOf(std::string_view query, const Layout& layout, const Region& otherwise) {
  constexpr double kMost = 1e9;
  const auto read = [&](const char* name, double low, uint32_t value) {
    return uint32_t(queryNumber(query, name, low, kMost, value));
  };
  Region region{read("x", 0, otherwise.x), read("y", 0, otherwise.y), read("width", 1, otherwise.width),
                read("height", 1, otherwise.height)};
  if (region.x >= layout.width || region.y >= layout.height) return std::nullopt;
  region.width = std::min(region.width, layout.width - region.x);
  region.height = std::min(region.height, layout.height - region.y);
  return region;
}

Answer outside() { return {404, "text/plain", "outside of the picture\n"}; }

}  // namespace

Answer Answers::pixels(std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  const std::optional<Region> region = regionOf(query, layoutOf(shot->data.desc), {0, 0, 1, 1});
  if (!region) return outside();
  const std::vector<uint32_t> all = words(shot->data, *region);
  return {200, "application/octet-stream",
          std::string(reinterpret_cast<const char*>(all.data()), all.size() * sizeof(uint32_t)),
          shotHeaders(*shot) + fmt::format("X-Fovea-Region: {}x{}\r\n", region->width, region->height)};
}

Answer Answers::numbersOf(std::string_view query) {
  Answer refusal;
  const ShotPointer shot = shotFor(query, refusal);
  if (!shot) return refusal;
  const Layout layout = layoutOf(shot->data.desc);
  const std::optional<Region> region = regionOf(query, layout, wholeOf(layout));
  if (!region) return outside();
  nlohmann::json channels = nlohmann::json::array();
  for (const ChannelStatistics& c : statistics(shot->data, *region))
    channels.push_back({{"min", c.min},
                        {"max", c.max},
                        {"mean", c.mean},
                        {"nan", c.nan},
                        {"infinite", c.infinite},
                        {"histogram", c.histogram}});
  return {200, "application/json", textOf({{"channels", channels}, {"frame", shot->frame}}),
          shotHeaders(*shot)};
}

Answer Answers::measures(std::string_view query) {
  Answer refusal;
  const auto [picture, reference] = pairFor(query, "reference", refusal);
  if (!picture || !reference) return refusal;
  const auto regions =
      measure(picture->data, reference->data, picture->exposure, picture->gaze, picture->foveaRadius);
  const auto json = [](const image::Measures& m) {  // NaN and infinity become null
    return nlohmann::json{{"pixels", m.pixels},  {"mse", m.mse},   {"psnr", m.psnr},
                          {"rel_mse", m.relMse}, {"flip", m.flip}, {"blocks", m.blocks}};
  };
  return {200, "application/json",
          textOf({{"fovea", json(regions.fovea)},
                  {"periphery", json(regions.periphery)},
                  {"whole", json(regions.whole)},
                  {"frame", picture->frame},
                  {"frames", reference->frames}})};
}

Answer Answers::command(const Request& request, const ReadBody& read) {
  const auto length = size_t(std::clamp<int64_t>(request.bodyBytes, 0, int64_t(kMaxBody)));
  const std::string body = read(length);
  if (body.size() < length) return {400, "text/plain", "the body is shorter than announced\n"};
  try {
    return exchange_.send(parseCommand(body)) ? Answer{204, "text/plain", {}} : busy();
  } catch (const Error& error) {
    return {400, "application/json", textOf(messagesJson(error))};
  }
}

}  // namespace fovea::view
