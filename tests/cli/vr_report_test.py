"""Tests benchmarks/vr_report.py from outside. Usage: vr_report_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import sys
import unittest

from program import BAD_INPUT, USAGE, ToolTest


class VrReport(ToolTest):
    script = "vr_report.py"

    def log(self, *rows):
        header = "frame,time_s,missed,gaze,gaze_to_display_ms,gaze_to_submit_ms,recording_ms\n"
        return self.write("frames.csv", header + "".join(row + "\n" for row in rows))

    def test_table_and_plot(self):
        log = self.log("0,0,0,1,20,,1", "1,0.011,0,0,,,3", "2,0.033,2,1,30,,2", "3,0.044,0,1,22,,4")
        timings = self.write("t.json", {"views": {"left": {"passes": 3, "ms": {"median": 5, "min": 4, "p95": 7}}}})
        self.succeeds(log, timings, "-o", "report")
        text = (self.folder / "report/vr.txt").read_text()
        self.assertIn("4 frames shown, 2 periods of the display missed, 1 frames without gaze.", text)
        for row in ("| gaze to display | 22.00 | 30.00 |", "| recording | 2.50 | 4.00 |", "| passes of view `left` | 5.00 | 7.00 |"):
            self.assertIn(row, text)
        self.assertNotIn("submission", text)
        for ending in ("png", "svg", "pdf"):
            self.assertGreater((self.folder / f"report/vr.{ending}").stat().st_size, 1000)

    def test_mistakes(self):
        self.refuses(BAD_INPUT, "none.csv", "-o", "report", says=["none.csv", "--log"])
        self.refuses(BAD_INPUT, self.log(), "-o", "report", says=["has no frames"])
        self.refuses(BAD_INPUT, self.log("0,0,x,1,20,,1"), "-o", "report", says=["frames.csv"])
        self.refuses(BAD_INPUT, self.log("0,0,0,1,20,,1"), self.write("t.json", "[]"), "-o", "report", says=["--timings"])
        self.refuses(USAGE, self.log("0,0,0,1,20,,1"), says=["-o"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
