"""All of the paper's experiments at their quick sizes: every measure holds, figures can be looked at, and what the page
says of the paper's statements is what docs/paper.md says."""

import glob
import json
import os
import struct
import unittest

from test_docs import ROOT
from test_paper import Paper

ITEMS = ("fig1 fig2 fig3 fig4 fig5 fig6 fig7ab fig7cd fig10 weights fig8 fig11 whole heat alpha mass-loss rival "
         "table1 all-at-once table2 crossing adaptive readings statements").split()


class All(Paper):
    def test_all(self):
        self.singe("paper", "all", "--quick", "-o", self.path("page"), timeout=1800)
        self.check_page("page", ITEMS)
        self.check_sizes("page")
        self.check_statements("page")

    def check_sizes(self, folder):
        for path in glob.glob(self.path(folder, "*.png")):
            with open(path, "rb") as file:
                width, height = struct.unpack(">II", file.read(24)[16:])
            self.assertTrue((width >= 320 and height >= 240) or "-01.png" in path, path)  # first ones may be textures

    def check_statements(self, folder):
        """Each has a measure on the page, and the same words in the documentation."""
        with open(self.path(folder, "measures.json")) as file:
            measures = {(m["item"], m["measure"]) for m in json.load(file)["measures"]}
        statements = self.table(folder, "statements.csv")
        with open(os.path.join(ROOT, "docs", "paper.md")) as file:
            rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in file if line[0] == "|"]
        rows = [row for row in rows if len(row) == 6 and row[0][0] in "5678"]
        for s in statements:
            item, measure = s["measure"].split(": ")
            self.assertIn((item, measure), measures)
            self.assertTrue(s["fails for"], measure)
            self.assertIn([s["section"], s["the paper states"], s["verdict"], f"`{item}`: {measure}", s["found"],
                           s["fails for"]], rows)
        self.assertEqual(len(rows), len(statements))


def load_tests(loader, tests, pattern):
    return unittest.TestSuite([All("test_all")])
