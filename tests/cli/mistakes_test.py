"""Tests that a mistake is reported once, at the line or the option where the user made it, with what is allowed.

Usage: mistakes_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import sys
import unittest

from program import BAD_INPUT, DIRECT, USAGE, CliTest

# In each file of a mistake, ¤ stands before the place where the message has to point.
PLACE = "¤"
# own.json extends this file, which extends a stock graph: two levels and more.
MIDDLE = '{ "version": 2, "extends": "ours.json", "parameters": { "vpl_count": 500 } }'
LIGHT = """{ "version": 2, "parameters": { "map_size": 512 },
  "passes": {
    "shadows": { "type": "shadow-map", "params": { "size": "$map_size" } },
    "light": { "type": "direct", "inputs": { "gbuffer": "inputs.gbuffer", "maps": "shadows" } }
  },
  "inputs": { "gbuffer": {} }, "outputs": { "radiance": "light" } }"""


def own(members, base="middle"):
    return f'{{ "version": 2, "extends": "{base}",\n  {members}\n}}'


def alone(passes, outputs='"image": "tonemap"', more=""):
    return ('{ "version": 2,' + more + ' "passes": {\n  "gbuffer": { "type": "gbuffer" },\n  ' + passes +
            '\n}, "outputs": { ' + outputs + " } }")


TONEMAP = '"tonemap": { "type": "tonemap", "inputs": { "radiance": "gbuffer.albedo" } }'
INSTANCE = alone('"lit": { "graph": "light.json", %s }, "tonemap": { "type": "tonemap", "inputs": { "radiance": '
                 '"lit.radiance" } }')

# Name: a text of own.json, and what the message has to contain.
IN_FILES = {
    # ---- values, through what the file extends
    "text for a number": (own('"parameters": { "map_size": ¤"big" }'), ["`map_size`", "a whole number from", "`big`"]),
    "number for a choice": (own('"parameters": { "kernel": ¤5 }'), ["`kernel`", "one of clamp, disc", "found 5"]),
    "unknown choice": (own('"parameters": { "kernel": ¤"dics" }'), ["one of clamp, disc", "did you mean `disc`"]),
    "out of range, used by several": (own('"parameters": { "vpl_count": ¤0 }'), ["`vpl_count`", "from 1 to", "found 0"]),
    "flag as a number": (own('"parameters": { "luminance": ¤1 }'), ["`luminance`", "true or false"]),
    "fraction": (own('"parameters": { "interleave": ¤2.5 }'), ["`interleave`", "one of 1, 2, 4, 8", "2.5"]),
    "list": (own('"parameters": { "kernel": ¤["disc"] }'), ["a number or a text", "an array"]),
    "object for a value": (own('"parameters": { "kernel": ¤{ "disc": 1 } }'), ["a number or a text", "an object"]),
    "unknown ending of a type": (own('"parameters": { "intensity": ¤"areas" }'),
                                 ["`intensity`", "one of area, ", "`areas`", "did you mean `area`"]),
    "ending of a type that does not fit": (own('"parameters": { "intensity": ¤"pdf" }', "foveal"),
                                           ["`intensity`", "one of importance-area, found `pdf`", "no input `traced`"]),
    "number as the ending of a type": (own('"parameters": { "intensity": ¤5 }'), ["`intensity`", "one of area, ", "found `5`"]),
    "value of a pass": (own('"passes": { "deferred": { "params": { "kernel": ¤"disk" } } }'), ["one of clamp, disc"]),
    "reference to another kind": (own('"passes": { "shadow-map": { "params": { "size": ¤"$kernel" } } }'),
                                  ["`size`", "a whole number from", "`clamp`"]),
    "reference to nothing": (own('"passes": { "deferred": { "params": { "kernel": ¤"$kernle" } } }'),
                             ["`$kernle`", "did you mean `$kernel`"]),
    "size that no device has": (own('"passes": { "shadow-map": { "params": { "size": ¤100000 } } }'), ["`size`", "to 16384"]),
    "value of the frame": (own('"view": { "materials": ¤"shiny" }'), ["one of diffuse, full", "`shiny`"]),
    "range of the frame": (own('"view": { "fovea_degrees": ¤90 }'), ["`fovea_degrees`", "from 0 to 60"]),
    "value of the scene that there is not": (own('"parameters": { "near_light": ¤"$scene.light" }'), ["`near_light`", "one of"]),
    # ---- names
    "unknown parameter of a pass": (own('"passes": { "deferred": { "params": { ¤"kernle": "disc" } } }'),
                                    ["no parameter `kernle`", "`kernel`"]),
    "unknown type": (own('"passes": { "mean": { "type": ¤"acumulate", "inputs": { "value": "direct" } } }'),
                     ["`acumulate`", "`accumulate`"]),
    "unknown key": (own('¤"paramters": { "kernel": "disc" }'), ["unknown key `paramters`", "`parameters`"]),
    "unknown key of a pass": (own('"passes": { "deferred": { ¤"prams": { "kernel": "disc" } } }'), ["`prams`", "`params`"]),
    "unknown key of the frame": (own('"view": { ¤"material": "full" }'), ["`material`", "`materials`"]),
    "unknown view": (own('"passes": { "gbuffer": { "view": ¤"centre" } }'), ["`centre`", "main, left, right"]),
    "file that is not there": ('{ "version": 2, "extends": ¤"our.json" }', ["`our.json`", "did you mean `ours.json`"]),
    "part that is not there": ('{ "version": 2, "extends": ¤"parts/vpl-bas" }', ["did you mean `parts/vpl-base`"]),
    "name that is none": (alone('¤"my pass": { "type": "gbuffer" }, ' + TONEMAP, '"image": "tonemap", "x": "my pass.depth"'),
                          ["`my pass` is no name", "letters, digits"]),
    # ---- wires
    "unknown pass": (own('"passes": { "tonemap": { "inputs": { "radiance": ¤"defered.radiance" } } }'),
                     ["no pass `defered`", "`deferred`"]),
    "unknown output": (own('"passes": { "tonemap": { "inputs": { "radiance": ¤"deferred.radience" } } }'),
                       ["no output `deferred.radience`", "`deferred.radiance`"]),
    "unknown input": (own('"passes": { "tonemap": { "inputs": { ¤"radience": "deferred.radiance" } } }'),
                      ["no input `radience`", "`radiance`"]),
    "wrong kind": (own('"passes": { "tonemap": { "inputs": { "radiance": ¤"shadow-map" } } }'), ["`radiance` wants"]),
    "wire that is a number": (own('"passes": { "tonemap": { "inputs": { "radiance": ¤7 } } }'), ["a wire such as", "7"]),
    "unknown member": (own('"outputs": { "depth": ¤"gbuffer.depht" }'), ["no output `gbuffer.depht`", "`gbuffer.depth`"]),
    "misspelt input of a new pass": (own('"passes": { "mine": { "type": "direct", "inputs": { "gbuffer": "gbuffer", ¤"mops": '
                                         '"shadow-map" } } }, "outputs": { "mine": "mine" }'), ["no input `mops`", "`maps`"]),
    "missing input": (own('"passes": { ¤"mean": { "type": "accumulate" } }, "outputs": { "mean": "mean" }'),
                      ["`value`", "not wired", "these would fit: "]),
    "cycle": (own('"passes": { "gbuffer-mean": { "type": "accumulate", "inputs": { "value": "deferred.radiance" } },\n'
                  '"direct": { "inputs": { "gbuffer": "gbuffer", "maps": "shadow-map" } },\n'
                  '"near-field-mean": { "inputs": { "samples": ¤"near-field-mean.mean" } } }'),
              ["near-field-mean", "@previous"]),
    "output of nothing": (own('"outputs": { "mean": ¤"mean" }'), ["no pass `mean`"]),
    "no outputs": ('¤{ "version": 2, "passes": { "gbuffer": { "type": "gbuffer" } } }', ["no outputs", '"image"']),
    # ---- patches
    "null of nothing": (own('"passes": { "mimpap": ¤null }'), ["removes nothing", "`mipmap`"]),
    "null of a pass that others need": (own('"passes": { "gbuffer": ¤null }'), ["passes.gbuffer", "passes.direct.inputs.gbuffer"]),
    "null of a parameter that is used": (own('"parameters": { "kernel": ¤null }'), ["parameters.kernel", "passes.deferred.params.kernel"]),
    "null of a wire that is needed": (own('"passes": { "direct": { "inputs": { "gbuffer": ¤null } } }'), ["passes.direct.inputs.gbuffer"]),
    "another type that others cannot read": (own('"passes": { "shadow-map": { "type": ¤"voxelize" } }'),
                                             ["`voxelize` does not fit", "`shadow-map`"]),
    "null of all passes": (own('"passes": ¤null'), ["`null` removes passes", "outputs.image"]),
    "null of all parameters": (own('"parameters": ¤null'), ["`null` removes parameters", " more"]),
    "null of all wires of a pass": (own('"passes": { "direct": { "inputs": ¤null } }'), ["passes.direct.inputs.maps"]),
    "null of a type": (own('"passes": { "direct": ¤{ "type": null } }'), ["`type` is missing"]),
    "type of another wiring": (own('"passes": { "direct": { "type": ¤"accumulate" } }'),
                               ["`accumulate` does not fit", "`value` is not wired", "`direct` wants"]),
    "several missing inputs": (own('"passes": { ¤"mine": { "type": "direct" } }, "outputs": { "mine": "mine" }'),
                               ["the inputs `gbuffer`", "`maps`", "are not wired"]),
    "type and graph": (own('"passes": { "mine": { "graph": ¤"light.json", "type": "direct" } }'), ["not both"]),
    "list for passes": (own('"passes": ¤[]'), ["expected an object", "an array"]),
    "text for parameters": (own('"parameters": ¤"none"'), ["expected an object", "parameters"]),
    "number for a pass": (own('"passes": { "gbuffer": ¤5 }'), ["expected an object", "passes.gbuffer"]),
    "number for a pass that is not inherited": (alone('"mean": ¤5, ' + TONEMAP, '"image": "tonemap", "mean": "mean.mean"'),
                                               ["expected an object", "passes.mean"]),
    "text for inputs": (own('"passes": { "gbuffer": { "params": ¤"none" }, "direct": { "comment": "" } }'), ["an object"]),
    "key that occurs twice": (own('"parameters": { "kernel": "disc" },\n  ¤"parameters": { "map_size": 64 }'),
                              ["occurs twice"]),
    "no JSON": (own('"parameters": { "kernel": "disc", ¤}'), ["not valid JSON"]),
    "version of the future": ('{ "version": ¤3, "extends": "ours.json" }', ["version", "2"]),
    "version as a text": ('{ "version": ¤"2", "extends": "ours.json" }', ["version", "2"]),
    # ---- sub-graphs
    "value for a sub-graph": (INSTANCE % '"inputs": { "gbuffer": "gbuffer" }, "parameters": { "map_size": ¤0 }',
                              ["`map_size`", "whole number from"]),
    "unknown parameter of a sub-graph": (INSTANCE % '"inputs": { "gbuffer": "gbuffer" }, "parameters": { ¤"map_sise": 64 }',
                                         ["`map_sise`", "`map_size`"]),
    "unknown input of a sub-graph": (INSTANCE % '"inputs": { "gbuffer": "gbuffer", ¤"maps": "gbuffer" }', ["`maps`", "gbuffer"]),
    "sub-graph that is not there": ((INSTANCE % '"inputs": {}').replace('"light.json"', PLACE + '"ligth.json"'),
                                    ["`ligth.json`", "did you mean `light.json`"]),
    "wrong kind for an input of a sub-graph": (INSTANCE % '"inputs": { "gbuffer": ¤"gbuffer.normal" }', ["`gbuffer` wants"]),
    "unknown output of a sub-graph": ((INSTANCE % '"inputs": { "gbuffer": "gbuffer" }')
                                      .replace('"lit.radiance"', PLACE + '"lit.radiant"'), ["`radiant`", "`lit.radiance`"]),
}

# The graph, a value of --set, and what the message has to contain.
BY_OPTION = [
    ("ours", "intensity=areas", ["`intensity`", "one of area, ", "did you mean `area`"]),
    ("foveal", "intensity=pdf", ["`intensity`", "one of importance-area, found `pdf`", "no output `worth`"]),
    ("ours", "vpl_count=0", ["`vpl_count`", "a whole number from 1 to", "found 0"]),
    ("ours", "vpl_count=many", ["`vpl_count`", "a whole number from 1 to", "found `many`"]),
    ("ours", "vpl_count=", ["`vpl_count`", "a whole number from 1 to"]),
    ("ours", "luminance=maybe", ["`luminance`", "true or false", "`maybe`"]),
    ("ours", "kernel=dics", ["one of clamp, disc", "did you mean `disc`"]),
    ("ours", "kernle=disc", ["no parameter `kernle`", "did you mean `kernel`"]),
    ("ours", "foo.bar=1", ["no pass `foo`", "there is: ", "deferred", "gbuffer"]),
    ("ours", "defered.kernel=disc", ["no pass `defered`", "did you mean `deferred`"]),
    ("ours", "deferred.kernle=disc", ["no parameter `kernle`", "did you mean `kernel`"]),
    ("ours", "deferred.kernel=disk", ["one of clamp, disc", "did you mean `disc`"]),
    ("ours", "deferred=disc", ["`deferred` is a pass", "--set deferred.PARAMETER=VALUE"]),
    ("ours", "exposure=2", ["no parameter `exposure`", "tonemap.exposure"]),
    ("ours", "materials=full", ["belongs to the frame", "--set view.materials=full"]),
    ("ours", "view.materials=shiny", ["one of diffuse, full"]),
    ("ours", "view.material=full", ["`material`", "`materials`"]),
    ("stereo", "right.kernle=disc", ["the sub-graph `right` has no parameter `kernle`", "`right.kernel`"]),
    ("stereo", "right.kernel=dics", ["one of clamp, disc", "did you mean `disc`"]),
    ("stereo", "rigth.kernel=disc", ["`rigth`", "did you mean `right`"]),
    ("stereo", "right/tonemap.exposure=bright", ["`exposure`", "a number", "`bright`"]),
    ("stereo", "right/tonemapp.exposure=1", ["`right/tonemapp`", "did you mean `right/tonemap`"]),
    ("foveal", "rays=pixels-host", ["no parameter `rays`", "contact-rays.rays"]),
    ("mine", "map_size=big", ["`map_size`", "a whole number from"]),
    ("ours", "deferred.interleave=3", ["`interleave`", "one of 1, 2, 4, 8"]),
    ("foveal", "radiance.terms=both", ["pass `radiance`", "the cones need the input `mips`", "set terms to `direct`"]),
    ("foveal", "manage.placement=importance", ["pass `manage`", "theirs is not known", "wire `candidate_importance`"]),
    ("foveal", "vpl-intensity.kernel=clamp", ["pass `vpl-intensity`", "choose kernel `disc`"]),
]


class Mistakes(CliTest):
    def setUp(self):
        super().setUp()
        self.write("middle.json", MIDDLE)
        self.write("light.json", LIGHT)
        self.write("mine.json", own('"parameters": { "map_size": 64 }'))

    def errors(self, *arguments, **more):
        run = self.call("check", *arguments, **more)
        self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
        return run.stderr, [line for line in run.stderr.splitlines() if ": error: " in line]

    def check_one(self, arguments, start, says):
        text, errors = self.errors(*arguments)
        self.assertEqual(len(errors), 1, text)
        self.assertTrue(errors[0].startswith(f"fovea: {start}: error: "), f"{start}\n{text}")
        for word in says:
            self.assertIn(word, text)

    def test_in_files(self):
        for name, (marked, says) in IN_FILES.items():
            with self.subTest(name=name):
                before, after = marked.split(PLACE)
                self.write("own.json", before + after)
                lines = before.split("\n")
                self.check_one(["own.json"], f"own.json:{len(lines)}:{len(lines[-1]) + 1}", says)

    def test_in_the_middle(self):
        """A mistake of the file between is one of that file, also where the last one uses it."""
        for name in ("text for a number", "ending of a type that does not fit", "null of a pass that others need",
                     "unknown pass", "another type that others cannot read"):
            with self.subTest(name=name):
                before, after = IN_FILES[name][0].replace('"extends": "middle"', '"extends": "ours"').split(PLACE)
                self.write("middle.json", before + after)
                self.write("own.json", own('"parameters": { "clamp_distance": 1 }'))
                lines = before.split("\n")
                self.check_one(["own.json"], f"middle.json:{len(lines)}:{len(lines[-1]) + 1}", IN_FILES[name][1])

    def test_by_option(self):
        for graph, value, says in BY_OPTION:
            with self.subTest(graph=graph, value=value):
                self.check_one([graph, "--set", value], f"--set {value}", says)

    def test_suggestions_could_be_wired(self):
        """Neither the pass's own output nor one that waits for it, with which the wires would form a circle."""
        self.write("own.json", own('"passes": { "mean": { "type": "accumulate" },\n'
                                   '  "tonemap": { "inputs": { "radiance": "mean" } } }'))
        text, errors = self.errors("own.json")
        self.assertEqual(len(errors), 1, text)
        self.assertIn("these would fit: direct.direct, ", text)
        self.assertNotRegex(text, r"fit:.*\b(?<!-)mean\.")

    def test_of_a_file_that_is_used_twice(self):
        eye = '{ "graph": "bad.json", "inputs": { "gbuffer": "gbuffer" } }'
        self.write("own.json", alone(f'"left": {eye}, "right": {eye}, {TONEMAP}', '"image": "tonemap", "l": "left.radiance", '
                                     '"r": "right.radiance"'))
        for old, new in (('"type": "direct"', '"type": "dirct"'), (', "maps": "shadows"', ""), ('"size"', '"sise"'),
                         ("512", '"big"'), ('"shadows" }', '"shadow" }'), ('"light" }', '"lihgt" }')):
            with self.subTest(new=new):
                self.write("bad.json", LIGHT.replace(old, new))
                text, errors = self.errors("own.json")
                self.assertEqual((len(errors), errors[0][:15]), (1, "fovea: bad.json"), text)

    def test_two_mistakes_are_two(self):
        self.write("own.json", own('"parameters": { "map_size": "big", "kernel": "dics" }'))
        self.assertEqual(len(self.errors("own.json", "--set", "voxels=0")[1]), 3)

    def test_options(self):
        for value in ("novalue", "=5"):
            self.fails(USAGE, "check", "ours", "--set", value, says=["name=value"])
        self.fails(USAGE, *DIRECT, "--seed", "4294967296", says=["from 0 to 4294967295"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
