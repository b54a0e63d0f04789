"""singe validate at its quick sizes: every measure holds, or misses as its grade says."""


import unittest

from test_paper import Paper

ITEMS = "heat umbrella front pmma cone oxygen damp plume beam disc kinetics ledgers grades".split()


class Validate(Paper):
    def test_all(self):
        self.singe("validate", "--quick", "-o", self.path("page"), timeout=900)
        self.check_page("page", ITEMS, bad_cases=False)
        grades, measures = ({(row["item"], row["measure"]): row["grade"] for row in self.table("page", name)}
                            for name in ("grades.csv", "measures.csv"))
        self.assertEqual(measures.pop(("front", "up_cotton"), "independent"), grades.pop(("front", "up_cotton")))
        self.assertEqual(measures, grades)  # but for the strips with gas, which the quick sizes have not

    def test_only(self):
        self.singe("validate", "--only", "kinetics", "-o", self.path("page"))
        self.check_page("page", ["kinetics"], bad_cases=False)
        _, err = self.singe("validate", "--only", "magic", expect=2)
        self.assertIn("there is no 'magic'", err)


def load_tests(loader, tests, pattern):
    return unittest.TestSuite([Validate("test_all"), Validate("test_only")])
