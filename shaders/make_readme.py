#!/usr/bin/env python3
"""Writes the page about the shader library from the comments in its headers.

Usage: shaders/make_readme.py > shaders/README.md
       shaders/make_readme.py --check    fails if the page differs, or if a function has no comment
"""

import re
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
WIDTH = 110  # of a declaration on the page

INTRODUCTION = """\
# The shader library

The shaders of passes, the stock ones and your own, include the headers of this folder. This page lists all that these
declare, with arguments, units and spaces. `shaders/make_readme.py > shaders/README.md` writes it from the comments in
the headers, and a test compares it.

{contents}
## How a shader uses it

A shader includes a header by its path in this folder. The extensions that this takes are on already, and so is
`#version`; a header that is included twice counts once.

```glsl
#include "scene/scene.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(rgba16f) uniform readonly image2D gbufferAlbedo;  // port `gbuffer`, member `albedo`
layout(rgba16f) uniform writeonly image2D darker;        // port `darker`

void main() {{
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(darker)))) return;
  imageStore(darker, p, imageLoad(gbufferAlbedo, p) / (1.0 + float(frame.index)));
}}
```

Set 0 belongs to the pass: the framework finds its bindings by the names of ports and numbers them. Set 1 is the scene,
the same for every pass of a frame. `scene/scene.glsl` declares it, and shaders write `frame`, `view` and `lights` as if
they were variables. [A pass of your own](../samples/own_pass/README.md) explains ports, push constants and the macros
that a pass defines.

Positions are in metres in world space, +Y is up, and directions are unit vectors, unless a comment says otherwise.
Radiance is in W/(sr m²), irradiance in W/m², both for each of the linear channels red, green and blue. Pixels are
counted from the top left corner, and the centre of pixel (x, y) is at (x + 0.5, y + 0.5). A random number in [0, 1) may
be 0 but is never 1.
"""

SET_1 = """\
### What set 1 holds

Buffers of texels are read by the functions of `scene/tables.glsl` and `scene/objects.glsl`, not directly.

| binding | name | contents |
|---|---|---|
"""

DEFINES = """\
### What headers expect of whoever includes them

A pass defines macros in the `define` of a step. Headers that are not in this table expect nothing.

| header | expects |
|---|---|
"""

# The folders, in the order of the page: title, what they are about, and a shader that uses them.
SUBJECTS = {
    "scene": ("The scene", "Frame, view, geometry, materials and lights of the scene, and what follows from them.", """\
#include "scene/scene.glsl"

// Radiosity at a diffuse surface from all lights of the scene, W/m^2, as if nothing hid them.
vec3 unshadowed(vec3 position, vec3 normal, vec3 reflectance) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.lightCount; ++i) {
    LightSample light = sampleLight(lights[i], position);
    sum += light.irradiance * max(dot(normal, light.direction), 0.0);
  }
  return reflectance * sum;
}
"""),
    "screen": ("The screen", "Pixels of this frame and of the one before, the surfaces that they show, and their colours.",
               """\
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)  // port `gbuffer`, members `distance` and `camera`

// How far the surfaces of two neighbouring pixels are apart, m.
float gapAt(ivec2 pixel) { return distance(surfaceAt(pixel).xyz, surfaceAt(pixel + ivec2(1, 0)).xyz); }
"""),
    "rays": ("Rays", "Rays through the triangles of the scene, and the light that they find, for passes that declare "
             "`rays`.", """\
#define RAY_PASSAGE 0
#include "rays/gather.glsl"

// Radiance that leaves what the eye sees at a point of the picture, with one bounce, W/(sr m^2).
vec3 seen(vec2 pixel) {
  TracedSurface surface = look(pixel);
  if (!surface.there) return frame.environment;
  uint stream = randomStream(frame.seed, frame.index, 0x6d79u, uint(pixel.x) | uint(pixel.y) << 16);
  vec3 rho = reflectance(surface);
  return emitted(surface) + diffuseLight(surface, rho) + rho * gather(surface, 1u, 1u, stream);
}
"""),
    "materials": ("Materials", "What surfaces with full materials reflect and let through.", """\
#include "materials/gloss.glsl"

// Radiance towards the eye for each unit of irradiance from a direction. The texels are those of the G-buffer.
vec3 response(vec4 albedo, vec4 normal, vec4 specular, vec4 emission, vec3 toEye, vec3 direction) {
  Reflector reflector = reflectorOf(glossOf(specular, normal.a, albedo.a, emission.a), normal.xyz, toEye);
  return reflected(reflector, direction, albedo.rgb);
}
"""),
    "sampling": ("Sampling", "Random numbers, low-discrepancy sequences, and samples in the fovea.", """\
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"

// A random pixel in the fovea, another one for every invocation and frame.
ivec2 pixelInFovea(uint invocation, float foveaRadius) {
  uint stream = randomStream(frame.seed, frame.index, 0x6d79u, invocation);
  return regionSample(kRegionFovea, makeFovea(view.gaze, view.size, foveaRadius), ivec2(view.size), stream);
}
"""),
    "voxels": ("Voxels", "The scene as voxels (pass `voxelize`), rays through them, cones through their mips (pass "
               "`mipmap`).", """\
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"

// Distance to the first voxel from a point that lies on no surface, m; -1 if there is none.
float distanceToVoxel(vec3 position, vec3 direction) {
  VoxelHit hit = traceVoxels(voxelsGrid(), position, direction, direction);
  return hit.side == kNoSide ? -1.0 : hit.distance;
}
"""),
    "vpls": ("VPLs", "Virtual point lights, their paraboloid maps, and the shadow maps of the scene's own lights.", """\
#include "scene/scene.glsl"
#include "vpls/vpl.glsl"

uniform samplerBuffer vpls;  // port `vpls`

// Irradiance / pi from a VPL with the kernel `disc`, as if nothing hid it.
vec3 lightOfVpl(uint slot, vec3 position, vec3 normal) {
  Vpl vpl = loadVpl(vpls, slot);
  vec3 to = vpl.position - position;
  float d2 = dot(to, to);
  float cosines = max(dot(to, normal), 0.0) * max(-dot(to, vpl.normal), 0.0) / max(d2, 1e-12);
  return vpl.intensity * cosines / (kPi * (d2 + vpl.area / kPi));
}
"""),
    "probes": ("Probes", "A grid of probes with irradiance and distances (passes `probe-rays` and `probe-blend`).", """\
#include "scene/scene.glsl"
#include "probes/light.glsl"

// Diffuse light that leaves a surface, W/(sr m^2).
vec3 fromProbes(ProbeGrid grid, vec3 position, vec3 normal, vec3 reflectance) {
  return reflectance * probeLight(grid, 0.3, position, normal, normalize(view.eye - position));
}
"""),
    "device": ("The device", "What makes results equal on all devices, and what replaces features that a device "
               "lacks.", """\
#include "device/sums.glsl"

layout(std430) buffer Total { uint low, high; } total;  // port `total`

// Adds to a sum that does not depend on the order in which invocations come.
void addToTotal(float number) { ADD_TO_SUM(total.low, total.high, number) }
"""),
    "records": ("Records", "Records and constants that shaders and C++ share. The headers above include those that they "
                "need.", None),
}

DECLARATION = re.compile(r"(?P<type>\w+(?:\[\w*\])?) (?P<name>\w+)\((?!.*\bDECLARE\b)")


class Header:
    """A header: `text` of its top comment, and `lines` of its declarations without bodies, with their comments."""

    def __init__(self, source):
        self.rest = source.split("\n")
        self.lines, self.functions, self.undocumented, self.bindings = [], [], [], []
        self.names, self.conditions = set(), []
        self.text = self.paragraphs(self.comment())
        self.documented = False  # whether the declaration in the line above has a comment
        while self.rest:
            self.next()
        self.tidy()

    # ---- Reading ----

    def comment(self):
        lines = []
        while self.rest and re.match(r" *//", self.rest[0]):
            lines.append(re.sub(r"^ *// ?", "", self.rest.pop(0)))
        return lines

    @staticmethod
    def paragraphs(lines):
        return [re.sub(r"\s*\n", " ", p) if not re.search(r"^ {2}", p, re.M) else p
                for p in "\n".join(lines).split("\n\n")]

    def until(self, end):
        """The lines up to the one in which all braces are closed and `end` stands."""
        lines, depth = [], 0
        while True:
            lines.append(self.rest.pop(0))
            code = re.sub(r"//.*", "", lines[-1])
            depth += code.count("{") - code.count("}")
            if depth <= 0 and end in code or not self.rest:
                break
        return lines

    def next(self):
        line = self.rest[0]
        if not line.strip():
            self.rest.pop(0)
            self.lines.append("")
            self.documented = False
        elif line.startswith("//"):
            text = self.comment()
            if not self.is_live():
                return
            if re.match(r"-{4} ", text[0]):
                self.lines += ["", "// ---- " + text.pop(0).strip("- ") + " ----", ""]
            self.lines += [("// " + t).rstrip() for t in text]
            self.documented = bool(text)
        elif line.startswith("#"):
            self.directive()
        elif re.match(r"SHARED_(BEGIN|END|SIZE|OFFSET)", line):
            self.rest.pop(0)
        elif re.match(r"struct ", line):
            self.struct()
        elif not self.is_live():
            self.rest.pop(0)
        elif DECLARATION.match(line) and not re.match(r"layout|LARGE_TEXELS|SCENE_TEXELS", line):
            self.function()
        else:
            self.variable()

    def is_live(self):
        return "c++" not in self.conditions

    def directive(self):
        line = self.rest.pop(0)
        while line.endswith("\\"):
            line = line[:-1].rstrip() + " " + self.rest.pop(0).strip()
        word = line[1:].split()[0]
        if word in {"if", "ifdef", "ifndef"}:
            self.conditions.append("c++" if "__cplusplus" in line else "feature" if "WITHOUT_" in line else
                                   "guard" if re.search(r"FOVEA_\w+_GLSL", line) else "shown")
            if self.conditions[-1] == "shown" and self.is_live():
                self.lines.append(line)
        elif word == "else":
            if self.conditions[-1] == "shown":
                self.lines.append(line)
            elif self.conditions[-1] == "c++":
                self.conditions[-1] = "glsl"
        elif word == "endif":
            if self.conditions.pop() == "shown" and self.is_live():
                self.lines.append("#endif")
        elif word == "define" and self.documented and self.is_live():
            found = re.match(r"#define (\w+)(\([^)]*\))?(.*)", line)
            name, arguments, value = found.groups()
            if name not in self.names:
                self.names.add(name)
                self.lines.append(f"#define {name}{arguments}" if arguments else f"#define {name}{value}")

    def struct(self):
        lines = self.until("};")
        name = re.match(r"struct (\w+)", lines[0]).group(1)
        if not self.is_live() or name in self.names:
            return
        self.names.add(name)
        members, inside = [], True
        for line in lines:
            if line.startswith("#"):
                inside = "__cplusplus" not in line if line.startswith("#if") else True
            elif inside:
                members.append(re.sub(r" SHARED_(ZERO|DEFAULT\([^)]*\))", "", line))
        pairs = [re.match(r"(.*?[;{])\s*(//.*)?$", m) for m in members]
        pairs = [p if p and not m.lstrip().startswith("//") else None for p, m in zip(pairs, members)]
        width = max((len(p.group(1)) for p in pairs if p and p.group(2)), default=0)
        for member, pair in zip(members, pairs):
            if pair and pair.group(2) and width + 2 + len(pair.group(2)) <= WIDTH + 10:
                member = pair.group(1).ljust(width + 2) + pair.group(2)
            self.lines.append(member)
        self.documented = True

    def function(self):
        lines = self.until("}")
        signature, found = [], re.compile(r"\)\s*\{")
        for line in lines:
            signature.append(line.strip())
            if found.search(line):
                break
        text = " ".join(signature)
        text = text[:found.search(text).start() + 1]
        name = DECLARATION.match(text).group("name")
        after = re.search(r"\{\s*(//.*)$", signature[-1]) or re.search(r"\}\s*(//.*)$", lines[-1])
        self.functions.append(name)
        known = text in self.names
        if not known and not self.documented and not after:
            self.undocumented.append(name)
        self.documented = self.documented or bool(after)
        if not known:
            self.names |= {text, name}
            self.lines += self.wrapped(text + ";" + ("  " + after.group(1) if after else ""))

    def wrapped(self, text):
        if len(text) <= WIDTH or "//" in text:
            return [text]
        start = text.index("(") + 1 if "(" in text else 6
        lines, line = [], ""
        for word in text.split(", "):
            if line and len(line) + len(word) + 2 > WIDTH:
                lines.append(line + ",")
                line = " " * start + word
            else:
                line += (", " if line else "") + word
        return lines + [line]

    def variable(self):
        lines = self.until(";")
        binding = re.match(r"SCENE_TEXELS\((\d+), \w+, (\w+)\);\s*(?:// (.*))?", lines[0]) or \
            re.match(r"layout\(set = 1, binding = (\d+)\) uniform .*?(\w+)(?:\[\w+\])?(?:; \})?;\s*(?:// (.*))?$",
                     lines[0])
        if binding:
            self.bindings.append(binding.groups())
        if re.match(r"(CONSTANT|SHARED_CONSTANT|const) ", lines[0]):
            comment = re.search(r"\s*(//.*)$", lines[-1])
            text = " ".join(re.sub(r"\s*//.*", "", line).strip() for line in lines)
            text = re.sub(r"^(SHARED_)?CONSTANT ", "const ", text)
            text = re.sub(r"(?<=\d)f\b", "", text)
            if len(text) > WIDTH and re.search(r"[({]", text):  # the value of a record or of a list
                text = re.sub(r" = .*;$", ";", text)
            lines = self.wrapped(text + ("  " + comment.group(1) if comment else ""))
        if "feature" not in self.conditions:  # what takes its place is behind functions and macros
            self.lines += lines
        self.documented = self.documented or "//" in lines[-1]

    # ---- Writing ----

    def tidy(self):
        """Drops conditions without declarations and blank lines in a row."""
        text = "\n".join(self.lines)
        before = None
        while before != text:
            before = text
            text = re.sub(r"(?m)^#if.*\n+(?:#else\n+)?#endif\n?", "", text)
            text = re.sub(r"(?m)^#else\n+#endif", "#endif", text)
            text = re.sub(r"\n{3,}", "\n\n", text)
        self.lines = text.strip("\n").split("\n") if text.strip() else []

    def expectations(self):
        return " ".join(p for p in self.text if re.match(r"(Define|Needs)", p))

    def page(self):
        parts = []
        for paragraph in self.text:
            parts.append(wrap(paragraph) if not re.search(r"^ {2}", paragraph, re.M)
                         else "```text\n" + paragraph + "\n```")
        if self.lines:
            parts.append("```glsl\n" + "\n".join(self.lines) + "\n```")
        return "\n\n".join(parts)


def wrap(text, width=120):
    lines, line = [], ""
    for word in text.split():
        if line and len(line) + 1 + len(word) > width:
            lines.append(line)
            line = word
        else:
            line += (" " if line else "") + word
    return "\n".join(lines + [line])


def headers():
    """The headers of the library by their paths in this folder. Programs that the framework runs itself are not."""
    paths = sorted(p for p in FOLDER.glob("*/*") if p.suffix in {".glsl", ".h"})
    return {str(p.relative_to(FOLDER)): Header(p.read_text(encoding="utf-8")) for p in paths}


def readme(library):
    parts = [INTRODUCTION.format(contents="".join(f"- [{title}](#{anchor(title)}): {about}\n"
                                                  for title, about, _ in SUBJECTS.values()))]
    bindings = sorted((b for h in library.values() for b in h.bindings), key=lambda b: int(b[0]))
    rows = {}  # a binding may be something else on some devices
    for n, name, what in bindings:
        rows.setdefault(n, []).append((f"`{name}`", (what or "").replace("|", chr(92) + "|")))
    parts.append(SET_1 + "".join(f"| {n} | {' or '.join(dict.fromkeys(names))} | {'; or '.join(dict.fromkeys(whats))} |\n"
                                 for n, row in rows.items() for names, whats in [zip(*row)]))
    parts.append(DEFINES + "".join(f"| [`{path}`](#{anchor(path)}) | {h.expectations()} |\n"
                                   for path, h in library.items() if h.expectations()))
    language = library["device/language.glsl"]
    parts.append("### Words that GLSL and C++ share: device/language.glsl\n\n" + language.page() + "\n")
    for folder, (title, about, example) in SUBJECTS.items():
        part = f"## {title}\n\n{wrap(about)}\n"
        if example:
            part += f"\n```glsl\n{example}```\n"
        paths = [p for p in library if p.startswith(folder + "/") and library[p] is not language]
        # What the example includes comes first.
        for path in sorted(paths, key=lambda p: f'"{p}"' not in (example or "")):
            part += f"\n### {path}\n\n{library[path].page()}\n"
        parts.append(part)
    return "\n".join(parts)


def anchor(path):
    return re.sub(r"[^\w-]", "", path.lower().replace(" ", "-"))


def undocumented(library):
    return [f"shaders/{path}: {name}() has no comment" for path, h in library.items() for name in h.undocumented]


def main():
    library = headers()
    page = readme(library)
    if sys.argv[1:] != ["--check"]:
        sys.stdout.write(page)
        return 0
    problems = undocumented(library)
    if (FOLDER / "README.md").read_text(encoding="utf-8") != page:
        problems.append("shaders/README.md is out of date: run shaders/make_readme.py > shaders/README.md")
    print("\n".join(problems), file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
