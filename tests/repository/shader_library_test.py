#!/usr/bin/env python3
"""The page of the shader library: it is up to date, complete, and every function has a comment.

Usage: shader_library_test.py SOURCE_DIR [unittest arguments]
"""

import importlib.util
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True


def generator():
    spec = importlib.util.spec_from_file_location("make_readme", SOURCE / "shaders/make_readme.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Library(unittest.TestCase):
    make_readme = generator()
    library = make_readme.headers()

    def test_the_page_is_up_to_date(self):
        page = (SOURCE / "shaders/README.md").read_text(encoding="utf-8")
        self.assertEqual(page, self.make_readme.readme(self.library),
                         "run shaders/make_readme.py > shaders/README.md")

    def test_every_function_has_a_comment(self):
        self.assertEqual(self.make_readme.undocumented(self.library), [])
        self.assertGreater(sum(len(h.functions) for h in self.library.values()), 200)

    def test_every_header_says_what_it_gives(self):
        for path, header in self.library.items():
            self.assertRegex(header.text[0] if header.text else "", r"^[A-Z].*\.", path)

    def test_every_function_and_record_is_on_the_page(self):
        """Found here in another way: whatever looks like one at the start of a line."""
        page = (SOURCE / "shaders/README.md").read_text(encoding="utf-8")
        found = 0
        for path in self.library:
            text = (SOURCE / "shaders" / path).read_text(encoding="utf-8")
            for name in re.findall(r"^(?:struct (\w+) \{|\w+ (\w+)\([^;]*\) \{)", text, re.M):
                found += 1
                self.assertRegex(page, rf"\b{''.join(name)}\b", f"{path}: {''.join(name)} is missing")
        self.assertGreater(found, 250)

    def test_each_binding_of_set_1_is_in_the_table(self):
        numbers = {int(b[0]) for h in self.library.values() for b in h.bindings}
        self.assertEqual(sorted(numbers), list(range(14)))
        self.assertTrue(all(b[2] for h in self.library.values() for b in h.bindings))


class Reading(unittest.TestCase):
    def header(self, text):
        guard = "#ifndef FOVEA_X_GLSL\n#define FOVEA_X_GLSL\n\n"
        return self.make_readme.Header("// A header.\n" + guard + text + "\n#endif\n")

    make_readme = generator()

    def test_functions_without_a_comment_are_noticed(self):
        self.assertEqual(self.header("float f(float x) { return x; }\n").undocumented, ["f"])
        self.assertEqual(self.header("// Apart.\n\nfloat f(float x) {\n  return x;\n}\n").undocumented, ["f"])
        header = self.header("// F.\nfloat f() { return 1.0; }\n\nfloat g() { return 2.0; }\n")
        self.assertEqual(header.undocumented, ["g"])

    def test_a_group_shares_a_comment(self):
        header = self.header("// Both.\nfloat f() {\n  return 1.0;\n}\nfloat g() { return 2.0; }\n\n"
                             "float h() { return 3.0; }  // three\n")
        self.assertEqual(header.undocumented, [])
        self.assertEqual(header.functions, ["f", "g", "h"])

    def test_bodies_are_left_out_and_conditions_stay(self):
        header = self.header("#if GLOSS\n// F.\nvec3 f(vec3 a,\n       INOUT(vec3) b) {\n  if (true) { b = a; }\n}\n"
                             "#endif\n")
        self.assertEqual(header.lines, ["#if GLOSS", "// F.", "vec3 f(vec3 a, INOUT(vec3) b);", "#endif"])

    def test_records_lose_the_words_of_c(self):
        header = self.header("// R.\nstruct R {\n  float a SHARED_ZERO;  // m\n  uint unused0 SHARED_ZERO;\n};\n")
        self.assertEqual(header.lines, ["// R.", "struct R {", "  float a;  // m", "  uint unused0;", "};"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:], verbosity=1)
